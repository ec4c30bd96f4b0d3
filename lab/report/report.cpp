#include "lab/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hwsim/gpu/gpu_keys.h"
#include "hwsim/gpu/gpu_rules.h"
#include "lab/base/base64.h"
#include "lab/base/build_info.h"
#include "lab/results/results.h"

namespace hwsim::lab {
namespace {

using Json = nlohmann::ordered_json;

Json number_in(const KeySlot& slot) {
  if (const auto* real = std::get_if<double*>(&slot)) return **real;
  if (const auto* whole = std::get_if<int*>(&slot)) return **whole;
  if (const auto* flag = std::get_if<bool*>(&slot)) return **flag;
  return nullptr;
}

/// The numbers that enter the timing, by key.
Json values_json(const GpuConfig& gpu) {
  GpuConfig copy = gpu;
  Json json = Json::object();
  for (const Key& key : keys_of(static_cast<GpuValues<double>&>(copy)))
    json[std::string(key.info.name)] = number_in(key.slot);
  return json;
}

/// Features and limits: what would need a new emulation.
Json functional_json(const GpuConfig& gpu) {
  GpuConfig copy = gpu;
  Json json = Json::object();
  for (const std::vector<Key>& keys : {keys_of(copy.features), keys_of(copy.functional)})
    for (const Key& key : keys) json[std::string(key.info.name)] = number_in(key.slot);
  return json;
}

Json keys_json() {
  GpuConfig gpu;
  Json json = Json::array();
  for (const Key& key : keys_of(static_cast<GpuValues<double>&>(gpu))) {
    const KeyInfo& info = key.info;
    const bool is_switch = std::holds_alternative<bool*>(key.slot);
    const bool is_whole = std::holds_alternative<int*>(key.slot) || info.has(kWhole);
    json.push_back({{"name", info.name},
                    {"type", is_switch  ? "switch"
                             : is_whole ? "whole"
                                        : "real"},
                    {"low", info.low},
                    {"high", info.high},
                    {"derivative", std::holds_alternative<double*>(key.slot)},
                    {"direction", info.has(kFaster)   ? "faster"
                                  : info.has(kSlower) ? "slower"
                                                      : "neither"},
                    {"meaning", info.description}});
  }
  return json;
}

Json quantiles_json(const std::map<Support, double>& quantiles) {
  Json json = Json::object();
  for (const auto& [support, quantile] : quantiles) json[std::string(support_name(support))] = quantile;
  return json;
}

Json intervals_json(const std::optional<cost_models::IntervalModel>& model) {
  if (!model) return nullptr;
  return {{"residual_log_sd", model->residual_log_sd},
          {"ratio_log_sd", model->ratio_log_sd},
          {"quantile90", quantiles_json(model->quantile90)},
          {"ratio_quantile90", quantiles_json(model->ratio_quantile90)},
          {"parameters", model->parameters},
          {"covariance", model->covariance}};
}

/// The keys that mean nothing on a GPU of this kind: the page does not offer their derivatives.
Json foreign_keys_json(const GpuConfig& config) {
  GpuConfig gpu = config;
  Json names = Json::array();
  for (const Key& key : keys_of(static_cast<GpuValues<double>&>(gpu)))
    if (!applies(key.info.name, gpu)) names.push_back(key.info.name);
  return names;
}

Json gpu_json(const OfferedGpu& gpu) {
  Json json = {{"id", gpu.config.id},
               {"title", gpu.config.title},
               {"hash", content_hash(gpu.config)},
               {"functional_hash", functional_hash(gpu.config)},
               {"values", values_json(gpu.config)},
               {"functional", functional_json(gpu.config)},
               {"foreign_keys", foreign_keys_json(gpu.config)},
               {"supports", Json::array()},
               {"fitted", Json::object()}};
  for (const Support support : gpu.supports) json["supports"].push_back(support_name(support));
  for (const auto& [key, parameter] : gpu.fitted) json["fitted"][key] = parameter;
  return json;
}

Json memory_json(const FrameMemory& memory) {
  Json json = {{"passes", memory.passes}, {"parts", Json::array()}};
  for (const LiveMemory& part : memory.parts)
    json["parts"].push_back(
        {{"name", part.name}, {"bytes", part.bytes}, {"first", part.first_pass}, {"last", part.last_pass}});
  return json;
}

Json point_json(const ReportedPoint& point) {
  return {{"label", label_of(point)},
          {"view", point.view},
          {"pictures", point.pictures_of},
          {"technique", point.technique},
          {"view_words", point.view_words},
          {"gpu_hash", content_hash(point.gpu)},
          {"functional_hash", functional_hash(point.gpu)},
          {"explanation", to_json(point.explanation)},
          {"memory", memory_json(point.memory)},
          {"reference", point.reference ? Json(*point.reference) : Json(nullptr)},
          {"flip_scale", point.pictures.flip.full_scale},
          {"heat_scale", point.pictures.heat.full_scale},
          {"trace", base64(point.trace)}};
}

Json what_if_json(const WhatIf& what_if) {
  Json changes = Json::object();
  for (const Assignment& change : what_if.changes) changes[change.path] = change.value;
  return {{"name", what_if.name}, {"about", what_if.about}, {"changes", changes}};
}

template <class T, class Function>
Json list_of(const std::vector<T>& parts, const Function& json_of) {
  Json json = Json::array();
  for (const T& part : parts) json.push_back(json_of(part));
  return json;
}

std::string point_sentence(const ReportedPoint& point) {
  const Result& result = point.explanation.result;
  std::string text =
      fmt::format("{} takes {} for a frame of {} at {}x{}.", label_of(point), headline_time(result.frame),
                  result.scene, result.resolution.width_px, result.resolution.height_px);
  if (const PassResult* slowest = slowest_pass(result))
    text += fmt::format(
        " Its slowest pass, {}, takes {:.3g} ms and is limited by {} ({:.0f} % of that time).", slowest->name,
        slowest->time_ms, slowest->limiter, 100.0 * limiter_share_ratio(point.explanation));
  return text;
}

/// " [9.1, 12.5]": of a ratio, from the interval of the change.
std::string ratio_interval(const std::optional<std::array<double, 2>>& change) {
  if (!change) return {};
  return fmt::format(" [{:.3g}, {:.3g}]", 1.0 + (*change)[0], 1.0 + (*change)[1]);
}

std::string extremes_sentence(const Report& report) {
  const auto [fast, slow] = extremes_of(report);
  const FrameResult &least = fast->explanation.result.frame, &most = slow->explanation.result.frame;
  return fmt::format(
      "The fastest of {} points is \u201c{}\u201d: {}. The slowest, \u201c{}\u201d, takes "
      "{:.3g}{} times as long: {}.",
      report.points.size(), label_of(*fast), headline_time(least), label_of(*slow),
      most.time_ms / least.time_ms, ratio_interval(report.spread_interval), headline_time(most));
}

std::string change_sentence(const Comparison& comparison) {
  const auto size = [](const Difference& d) {
    return std::abs(relative_change(d.time_ms.before, d.time_ms.after).value_or(0.0));
  };
  const Difference& most = *std::ranges::max_element(comparison.differences, std::less{}, size);
  const double change = relative_change(most.time_ms.before, most.time_ms.after).value_or(0.0);
  std::string interval;
  if (const auto& ends = most.time_change_interval)
    interval = fmt::format(" [{:+.1f}, {:+.1f}]", 100.0 * (*ends)[0], 100.0 * (*ends)[1]);
  return fmt::format("\u201c{}\u201d changes the time most, by {:+.1f} %{}: from {:.3g} to {:.3g} ms.",
                     most.label, 100.0 * change, interval, most.time_ms.before, most.time_ms.after);
}

std::string choice_text(const SweepChoice& choice) {
  std::string text;
  for (const auto& [axis, value] : choice.what) text += (text.empty() ? "" : ", ") + axis + " " + value;
  return text;
}

std::string sweep_sentence(const SweepFindings& found) {
  std::string text =
      fmt::format("{} points take {:.3g} to {:.3g} ms.", found.points, found.fastest_ms, found.slowest_ms);
  if (!found.best.empty() && !found.best.front().what.empty())
    text += " The fastest: " + choice_text(found.best.front()) + ".";
  if (!found.effects.empty())
    text += fmt::format(" {} matters most: {:.0f} % of the variance, {:.3g} times as long at {} as at {}.",
                        found.effects.front().axis, 100.0 * found.effects.front().share_ratio,
                        found.effects.front().slowest_ms / found.effects.front().fastest_ms,
                        found.effects.front().slowest, found.effects.front().fastest);
  return text;
}

std::string reproduction_sentence(const Reproduction& reproduction, const Belief& belief) {
  if (!reproduction.figures) return "No fitted time of " + reproduction.paper + " could be predicted.";
  const cost_models::Figures& f = *reproduction.figures;
  std::string text = fmt::format(
      "Of {}'s {} fitted times, predictions miss by {:.1f} % in the mean and {:.1f} % in the median; {:.0f} "
      "% lie within "
      "their 90 % intervals.",
      reproduction.paper, f.cells, f.mape_pct, f.median_ape_pct, f.coverage90_pct);
  if (const auto ratios = ratios_of(belief, reproduction.paper); !ratios.empty())
    text += fmt::format(" Of {} pairs of techniques that it compares, {} are predicted in its order.",
                        ratios.size(), in_published_order(ratios));
  return text;
}

}  // namespace

std::string label_of(const ReportedPoint& point) {
  const Result& result = point.explanation.result;
  return result.technique + " on " + result.gpu + (point.view.empty() ? "" : ", " + point.view);
}

std::pair<const ReportedPoint*, const ReportedPoint*> extremes_of(const Report& report) {
  const auto time = [](const ReportedPoint& point) { return point.explanation.result.frame.time_ms; };
  const auto [fast, slow] = std::ranges::minmax_element(report.points, std::less{}, time);
  return {&*fast, &*slow};
}

std::string answer_of(const Report& report) {
  if (report.reproduction) return reproduction_sentence(*report.reproduction, report.belief);
  if (!report.rankings.empty()) return answer_of(report.rankings) + ".";
  if (report.comparison && !report.comparison->differences.empty())
    return change_sentence(*report.comparison);
  if (report.sweep && report.sweep->findings.points > 1) return sweep_sentence(report.sweep->findings);
  if (report.points.size() > 1) return extremes_sentence(report);
  return point_sentence(report.points.front());
}

Json to_json(const Report& report) {
  const BuildInfo build = build_info();
  const auto variation_json = [](const TriedVariation& v) {
    return Json{{"label", v.label}, {"point", v.point}, {"values", values_json(v.gpu)}};
  };
  const auto region_json = [](const Region& r) { return Json{{"x", r.x}, {"y", r.y}, {"side", r.side}}; };
  Json json = {
      {"schema_version", kReportSchemaVersion},
      {"version", build.version},
      {"commit", build.commit},
      {"command", report.command},
      {"title", report.title},
      {"answer", answer_of(report)},
      {"limits", report.limits},
      {"keys", keys_json()},
      {"gpus", list_of(report.gpus, gpu_json)},
      {"catalog_hashes", report.catalog_hashes},
      {"intervals", intervals_json(report.intervals)},
      {"points", list_of(report.points, point_json)},
      {"what_ifs", list_of(report.what_ifs, what_if_json)},
      {"variations", list_of(report.variations, variation_json)},
      {"regions", list_of(report.regions, region_json)},
      {"rankings", list_of(report.rankings, [](const Ranking& ranking) { return to_json(ranking); })},
      {"comparison", report.comparison ? to_json(*report.comparison) : Json(nullptr)},
      {"sweep", report.sweep ? to_json(report.sweep->rows) : Json(nullptr)},
      {"reproduction", report.reproduction ? to_json(*report.reproduction) : Json(nullptr)}};
  json.update(to_json(report.belief));
  return json;
}

}  // namespace hwsim::lab
