#include "lab/studies/external.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "cost_models/intervals.h"
#include "cost_models/kept_traces.h"
#include "cost_models/statistics.h"
#include "hwsim/base/byte_codec.h"
#include "hwsim/timing/time_slopes.h"
#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/studies/published_runs.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;
using cost_models::Cell;
using cost_models::RowUse;

constexpr double kMsPerNs = 1e-6, kMsPerUs = 1e-3;

/// The passes that a row times, as a frame of their own.
WorkTrace passes_of(const WorkTrace& trace, const std::string& patterns) {
  WorkTrace part = trace;
  std::erase_if(part.passes,
                [&](const PassWork& pass) { return !cost_models::pass_matches(patterns, pass.name); });
  return part;
}

ExternalRow predicted_row(const Cell& cell, const WorkTrace& trace, const GpuConfig& gpu,
                          const cost_models::Calibration* calibration) {
  const cost_models::PublishedRow& printed = cell.row;
  ExternalRow row{printed.id(), printed.gpu, printed.technique, printed.msaa, printed.lighting, printed.pass};
  row.published_ms = cell.published;
  const WorkTrace part = passes_of(trace, cell.passes);
  const double present_ms = cell.present_us * kMsPerUs;
  const std::string fitted_id = calibration ? cost_models::calibrated_id(*calibration, gpu) : std::string();
  TimeSlopes slopes(gpu, fitted_id.empty() ? std::vector<std::string>()
                                           : cost_models::interval_keys(*calibration, fitted_id));
  const FrameTiming timing = time_frame(part, gpu, Engine::queue, {}, &slopes);
  row.predicted_ms = timing.time_ns * kMsPerNs + present_ms;
  row.support = support_name(Support::uncalibrated);
  if (fitted_id.empty()) return row;
  const cost_models::FrameInterval found =
      cost_models::frame_interval(*calibration, {timing.time_ns, slopes.ns()}, gpu, cell.run.technique);
  row.support = support_name(found.support);
  if (found.interval_ns)
    row.interval_ms = {(*found.interval_ns)[0] * kMsPerNs + present_ms,
                       (*found.interval_ns)[1] * kMsPerNs + present_ms};
  return row;
}

double error_pct(const ExternalRow& row) {
  return cost_models::percent_error(row.predicted_ms, row.published_ms);
}

ExternalErrors errors_of_rows(const std::vector<const ExternalRow*>& rows) {
  ExternalErrors errors{.rows = rows.size()};
  if (rows.empty()) return errors;
  std::vector<double> apes, widths;
  double logs = 0.0, inside = 0.0;
  for (const ExternalRow* row : rows) {
    apes.push_back(error_pct(*row));
    logs += std::log(row->predicted_ms / row->published_ms);
    if (!row->interval_ms) continue;
    const auto [low, high] = *row->interval_ms;
    widths.push_back(high / low);
    inside += low <= row->published_ms && row->published_ms <= high ? 1.0 : 0.0;
  }
  errors.mape_pct = cost_models::mean(apes);
  errors.median_ape_pct = cost_models::median(apes);
  errors.bias_pct = 100.0 * std::expm1(logs / static_cast<double>(rows.size()));
  if (widths.empty()) return errors;
  errors.coverage90_pct = 100.0 * inside / static_cast<double>(widths.size());
  errors.width_ratio = cost_models::median(widths);
  return errors;
}

NamedValues<ExternalErrors> errors_by(const std::vector<ExternalRow>& rows, std::string ExternalRow::*label) {
  std::map<std::string, std::vector<const ExternalRow*>> groups;
  for (const ExternalRow& row : rows) groups[row.*label].push_back(&row);
  NamedValues<ExternalErrors> errors;
  for (const auto& [name, group] : groups) errors.emplace_back(name, errors_of_rows(group));
  return errors;
}

/// One thing in which rows may differ, and the two values that are compared.
struct RatioKind {
  const char* name;
  std::string ExternalRow::*label;
  const char *above, *below;
};
constexpr const char *kForward = "light-indexed deferred (forward+)", *kTiled = "tile-based deferred";
const RatioKind kRatios[] = {
    {"lights 1024 / 128", &ExternalRow::lights, "1024", "128"},
    {"lights 512 / 256", &ExternalRow::lights, "512", "256"},
    {"samples 4 / 1", &ExternalRow::msaa, "4", "1"},
    {"samples 2 / 1", &ExternalRow::msaa, "2", "1"},
    {"forward by lists / tiles", &ExternalRow::technique, kForward, kTiled},
    {"without / with z pre-pass", &ExternalRow::technique, "tile-based deferred without z pre-pass", kTiled}};

/// Alike in everything but `label`.
bool is_counterpart(const ExternalRow& a, const ExternalRow& b, std::string ExternalRow::*label) {
  for (const auto field : {&ExternalRow::gpu, &ExternalRow::technique, &ExternalRow::msaa,
                           &ExternalRow::lights, &ExternalRow::pass})
    if (field != label && a.*field != b.*field) return false;
  return true;
}

ExternalRatioErrors ratio_errors(const std::vector<ExternalRow>& rows, const RatioKind& kind) {
  std::vector<double> errors;
  for (const ExternalRow& above : rows) {
    if (above.*kind.label != kind.above) continue;
    for (const ExternalRow& below : rows)
      if (below.*kind.label == kind.below && is_counterpart(above, below, kind.label))
        errors.push_back(cost_models::percent_error(above.predicted_ms / below.predicted_ms,
                                                    above.published_ms / below.published_ms));
  }
  if (errors.empty()) return {};
  return {errors.size(), cost_models::mean(errors), cost_models::median(errors)};
}

[[noreturn]] void fail_unkept(const std::string& path, const std::string& why) {
  fail("M008", fmt::format("`{}` holds no work of this version: {}", path, why), "",
       "`--scenes FOLDER` emulates the frames from scene files, scripts/keep_traces.sh keeps them");
}

cost_models::KeptTraces read_kept(const std::string& path) try {
  const std::string text = read_file(path);
  return cost_models::decode_kept(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
} catch (const DamagedBytes& damage) {
  fail_unkept(path, damage.what());
}

}  // namespace

std::vector<Cell> external_cells(const ConfigFolder& folder) {
  return cost_models::map_rows(cost_models::load_published(folder.external()), folder.external());
}

cost_models::TraceSource external_traces(const std::string& scenes_folder, Session& session) {
  if (scenes_folder.empty())
    return cost_models::source_of(read_kept(session.files().folder().external() + "/work.traces"));
  const cost_models::TraceSource emulated =
      emulated_traces(session.jobs(), session.cache(), session.observer());
  return [emulated, scenes_folder](const cost_models::RunSpec& run, const GpuConfig& gpu) {
    cost_models::RunSpec here = run;
    here.scene = (fs::path(scenes_folder) / run.scene).string();
    return emulated(here, gpu);
  };
}

ExternalValidation validate_external(const cost_models::TraceSource& traces, Session& session,
                                     const std::function<void(double, const std::string&)>& progress) {
  const auto calibration = session.files().calibration();
  const std::vector<Cell> cells = external_cells(session.files().folder());
  ExternalValidation validation;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Cell& cell = cells[i];
    if (cell.use != RowUse::checked) {
      validation.not_run.push_back({cell.row.id(), cell.reason});
      continue;
    }
    if (progress) progress(static_cast<double>(i) / static_cast<double>(cells.size()), cell.run.to_string());
    const GpuConfig gpu = session.files().gpu(cell.run.gpu, {}, {}, true);
    validation.rows.push_back(predicted_row(cell, *traces(cell.run, gpu), gpu, calibration.get()));
  }
  std::vector<const ExternalRow*> all;
  for (const ExternalRow& row : validation.rows) all.push_back(&row);
  validation.all = errors_of_rows(all);
  validation.gpus = errors_by(validation.rows, &ExternalRow::gpu);
  validation.passes = errors_by(validation.rows, &ExternalRow::pass);
  validation.techniques = errors_by(validation.rows, &ExternalRow::technique);
  for (const RatioKind& kind : kRatios)
    validation.ratios.emplace_back(kind.name, ratio_errors(validation.rows, kind));
  return validation;
}

namespace {

using Json = nlohmann::ordered_json;

Json errors_json(const ExternalErrors& e) {
  return {{"rows", e.rows},
          {"mape_pct", e.mape_pct},
          {"median_ape_pct", e.median_ape_pct},
          {"bias_pct", e.bias_pct},
          {"coverage90_pct", e.coverage90_pct},
          {"width_ratio", e.width_ratio}};
}

Json named_json(const NamedValues<ExternalErrors>& values) {
  Json json = Json::object();
  for (const auto& [name, errors] : values) json[name] = errors_json(errors);
  return json;
}

Json row_json(const ExternalRow& row) {
  Json json = {{"row", row.row},
               {"gpu", row.gpu},
               {"technique", row.technique},
               {"msaa", row.msaa},
               {"lights", row.lights},
               {"pass", row.pass},
               {"published_ms", row.published_ms},
               {"predicted_ms", row.predicted_ms},
               {"support", row.support},
               {"interval_ms", nullptr}};
  if (row.interval_ms) json["interval_ms"] = *row.interval_ms;
  return json;
}

void add_errors(Table& table, const std::string& name, const ExternalErrors& e) {
  const bool intervals = e.width_ratio > 0.0;
  table.rows.push_back({name, std::uint64_t{e.rows}, Real{e.mape_pct, 1}, Real{e.median_ape_pct, 1},
                        Real{e.bias_pct, 1},
                        intervals ? TableCell{Real{e.coverage90_pct, 0}} : NotApplicable{},
                        intervals ? TableCell{Real{e.width_ratio, 1}} : NotApplicable{}});
}

}  // namespace

Json to_json(const ExternalValidation& validation) {
  Json json = {{"schema_version", 1},
               {"all", errors_json(validation.all)},
               {"gpus", named_json(validation.gpus)},
               {"passes", named_json(validation.passes)},
               {"techniques", named_json(validation.techniques)},
               {"ratios", Json::object()},
               {"rows", Json::array()},
               {"not_run", Json::array()}};
  for (const auto& [name, e] : validation.ratios)
    json["ratios"][name] = {
        {"pairs", e.pairs}, {"mape_pct", e.mape_pct}, {"median_ape_pct", e.median_ape_pct}};
  for (const ExternalRow& row : validation.rows) json["rows"].push_back(row_json(row));
  for (const UnpredictedRow& row : validation.not_run)
    json["not_run"].push_back({{"row", row.row}, {"reason", row.reason}});
  return json;
}

Table external_errors_table(const ExternalValidation& validation) {
  Table table{{{"name", "external"},
               {"rows", "rows", true},
               {"mape_pct", "MAPE %", true},
               {"median_ape_pct", "median %", true},
               {"bias_pct", "bias %", true},
               {"coverage90_pct", "in 90 % interval", true},
               {"width_ratio", "its width", true}},
              {}};
  add_errors(table, "all", validation.all);
  for (const auto* group : {&validation.gpus, &validation.passes, &validation.techniques})
    for (const auto& [name, errors] : *group) add_errors(table, name, errors);
  return table;
}

Table external_ratios_table(const ExternalValidation& validation) {
  Table table{{{"ratio", "ratio"},
               {"pairs", "pairs", true},
               {"mape_pct", "MAPE %", true},
               {"median_ape_pct", "median %", true}},
              {}};
  for (const auto& [name, e] : validation.ratios)
    table.rows.push_back({name, std::uint64_t{e.pairs}, Real{e.mape_pct, 1}, Real{e.median_ape_pct, 1}});
  return table;
}

Table external_rows_table(const ExternalValidation& validation) {
  Table table{{{"gpu", "GPU"},
               {"technique", "technique"},
               {"msaa", "samples", true},
               {"lights", "lights", true},
               {"pass", "pass"},
               {"published_ms", "published ms", true},
               {"predicted_ms", "predicted ms", true},
               {"error_pct", "error %", true},
               {"low_ms", "90 % from", true},
               {"high_ms", "to", true}},
              {}};
  for (const ExternalRow& row : validation.rows)
    table.rows.push_back({row.gpu, row.technique, row.msaa, row.lights, row.pass, Real{row.published_ms, 2},
                          Real{row.predicted_ms, 2},
                          Real{100.0 * (row.predicted_ms / row.published_ms - 1.0), 1},
                          row.interval_ms ? TableCell{Real{(*row.interval_ms)[0], 2}} : NotApplicable{},
                          row.interval_ms ? TableCell{Real{(*row.interval_ms)[1], 2}} : NotApplicable{}});
  return table;
}

}  // namespace hwsim::lab
