#include "lab/report/offers.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "algos/techniques.h"
#include "hwsim/config/toml_file.h"

namespace hwsim::lab {
namespace {

bool is_offered(const Report& report, const GpuConfig& gpu) {
  return std::ranges::any_of(report.gpus, [&](const OfferedGpu& offered) {
    return offered.config.id == gpu.id && content_hash(offered.config) == content_hash(gpu);
  });
}

std::string text_of(const TomlValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text ? *text : to_toml(value);
}

void add_once(std::vector<std::string>& sentences, const std::string& sentence) {
  if (std::ranges::find(sentences, sentence) == sentences.end()) sentences.push_back(sentence);
}

}  // namespace

void offer_gpus(Report& report, ConfigFiles& files) {
  const auto offer = [&](const GpuConfig& gpu) {
    if (!is_offered(report, gpu)) report.gpus.push_back({gpu, {}});
  };
  for (const ReportedPoint& point : report.points) offer(point.gpu);
  for (const std::string& id : list_gpus(files.folder().gpus())) {
    offer(files.gpu(id, {}, {}, true));
    report.catalog_hashes[id] = content_hash(files.gpu(id, {}, {}, true));
  }
  const auto calibration = files.calibration();
  if (!calibration) return;
  report.intervals = cost_models::interval_model(*calibration);
  for (OfferedGpu& gpu : report.gpus) {
    const std::string fitted_id = cost_models::calibrated_id(*calibration, gpu.config);
    const std::vector<std::string> keys = cost_models::interval_keys(*calibration, fitted_id);
    const std::vector<std::string> ids = cost_models::interval_parameters(*calibration, fitted_id);
    for (std::size_t i = 0; i < keys.size(); ++i) gpu.fitted.emplace_back(keys[i], ids[i]);
    for (const ReportedPoint& point : report.points)
      gpu.supports.push_back(point.calibrated ? cost_models::support_of(*calibration, gpu.config,
                                                                        point.explanation.result.technique)
                                              : Support::uncalibrated);
  }
}

void offer_what_ifs(Report& report, const ConfigFolder& folder) {
  for (const std::string& name : folder.overlay_names()) {
    WhatIf what_if{.name = name};
    std::vector<Diagnostic> problems;
    for (const TomlEntry& entry : read_toml_file(folder.overlay_file(name), problems).entries) {
      if (!entry.value || entry.path == "schema" || entry.path == "kind") continue;
      if (entry.path == "about")
        what_if.about = text_of(*entry.value);
      else
        what_if.changes.push_back({entry.path, text_of(*entry.value)});
    }
    report.what_ifs.push_back(std::move(what_if));
  }
}

namespace {

/// What the support of some points means; `names` lists them.
std::string support_limit(const std::string& support, const std::string& names) {
  if (support == "extrapolated")
    return names + ": extrapolated. No published time of these techniques, or of such a GPU, was fitted.";
  if (support == "interpolated") return names + ": interpolated. The techniques were fitted on other GPUs.";
  return names +
         ": uncalibrated. Rates are those of documents, efficiencies are assumed, and no interval can be "
         "given. "
         "Trust ratios on one GPU more than times.";
}

}  // namespace

void note_limits(Report& report) {
  const std::vector<std::string> of_scenes = std::move(report.limits);
  report.limits.clear();
  std::map<std::string, std::vector<std::string>> by_support;
  for (const ReportedPoint& point : report.points) {
    const Result& result = point.explanation.result;
    const bool uncalibrated = result.frame.support == "uncalibrated";
    if (result.frame.support != "calibrated")
      add_once(by_support[result.frame.support],
               uncalibrated ? result.gpu : result.technique + " on " + result.gpu);
  }
  for (const auto& [support, names] : by_support)
    report.limits.push_back(support_limit(support, fmt::format("{}", fmt::join(names, ", "))));
  for (const ReportedPoint& point : report.points) {
    const Result& result = point.explanation.result;
    if (result.engine != "queue")
      add_once(report.limits, "The report's times are those of engine " + result.engine +
                                  "; moved hardware is timed by engine queue.");
    for (const std::string& warning : result.warnings)
      add_once(report.limits, label_of(point) + ": " + warning);
  }
  for (const std::string& note : of_scenes) add_once(report.limits, note);
}

}  // namespace hwsim::lab
