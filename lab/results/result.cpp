#include "lab/results/result.h"

#include <algorithm>

#include "algos/rooms.h"
#include "hwsim/base/units_of_measure.h"
#include "lab/results/results.h"

namespace hwsim::lab {
namespace {

using Json = nlohmann::ordered_json;
using Interval = std::optional<std::array<double, 2>>;

Interval in_ms(const Interval& interval_ns) {
  if (!interval_ns) return std::nullopt;
  return std::array{(*interval_ns)[0] / kNsPerMs, (*interval_ns)[1] / kNsPerMs};
}

PassResult make_pass(const PassTiming& pass, const PassWork& work) {
  PassResult result{.name = pass.name,
                    .kind = std::string(pass_kind_name(pass.kind)),
                    .time_ms = pass.time_ns / kNsPerMs,
                    .limiter = std::string(unit_name(pass.limiter))};
  for (std::size_t u = 0; u < kUnitCount; ++u)
    result.units.emplace_back(unit_name(static_cast<Unit>(u)), pass.sol_ratio[u]);
  for (std::size_t s = 0; s < kStreamCount; ++s)
    result.bytes.emplace_back(stream_name(static_cast<Stream>(s)),
                              pass.dram_bytes.read[s] + pass.dram_bytes.write[s]);
  const PassCounters counters = total(work);
  for (const auto& [info, place] : algos::counters())
    result.counters.emplace_back(info.id, values(counters)[place]);
  return result;
}

FrameResult make_frame(const PointResult& point) {
  const FrameTiming& timing = point.timing;
  const WorkTrace& trace = point.emulation->trace;
  return {.time_ms = timing.time_ns / kNsPerMs,
          .interval_ms = in_ms(timing.interval_ns),
          .support = std::string(support_name(timing.support)),
          .error_sources = point.error_sources,
          .memory_mib = static_cast<double>(trace.peak_memory_bytes) / kBytesPerMib,
          .allocated_mib = static_cast<double>(trace.allocated_memory_bytes) / kBytesPerMib,
          .dram_mb = (timing.dram_bytes.total_read() + timing.dram_bytes.total_write()) / kBytesPerMb,
          .shaded_samples = algos::shaded_samples(trace)};
}

template <class T>
Json named_json(const NamedValues<T>& values) {
  Json json = Json::object();
  for (const auto& [name, value] : values) json[name] = value;
  return json;
}

template <class T>
NamedValues<T> named_from_json(const Json& json) {
  NamedValues<T> values;
  for (const auto& [name, value] : json.items()) values.emplace_back(name, value.template get<T>());
  return values;
}

/// A quantity that no run can have below 0. Throws nlohmann::json::exception.
double amount(const Json& json) {
  const double value = json.get<double>();
  if (!(value >= 0.0 && value <= 1e300))
    throw Json::type_error::create(302, "a quantity is below 0 or without an end", &json);
  return value;
}

std::uint64_t count(const Json& json) {
  if (!json.is_number_unsigned()) throw Json::type_error::create(302, "a count is no whole number", &json);
  return json.get<std::uint64_t>();
}

template <class T>
NamedValues<T> named_from_json(const Json& json, T (*read)(const Json&)) {
  NamedValues<T> values;
  for (const auto& [name, value] : json.items()) values.emplace_back(name, read(value));
  return values;
}

Json interval_json(const Interval& interval) {
  return interval ? Json{(*interval)[0], (*interval)[1]} : Json(nullptr);
}

Interval interval_from_json(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return std::array{json.at(0).get<double>(), json.at(1).get<double>()};
}

Json pass_json(const PassResult& pass) {
  return {{"name", pass.name},
          {"kind", pass.kind},
          {"time_ms", pass.time_ms},
          {"limiter", pass.limiter},
          {"units", named_json(pass.units)},
          {"bytes", named_json(pass.bytes)},
          {"counters", named_json(pass.counters)}};
}

PassResult pass_from_json(const Json& json) {
  return {.name = json.at("name").get<std::string>(),
          .kind = json.value("kind", ""),
          .time_ms = amount(json.at("time_ms")),
          .limiter = json.at("limiter").get<std::string>(),
          .units = named_from_json<double>(json.value("units", Json::object()), amount),
          .bytes = named_from_json<double>(json.at("bytes"), amount),
          .counters = named_from_json<std::uint64_t>(json.at("counters"), count)};
}

Json sources_json(const cost_models::ErrorSources& sources) {
  return {{"by_parameter", named_json(sources.by_parameter)}, {"by_unit", named_json(sources.by_unit)}};
}

cost_models::ErrorSources sources_from_json(const Json& json) {
  const Json none = Json::object();
  return {named_from_json<double>(json.value("by_parameter", none)),
          named_from_json<double>(json.value("by_unit", none))};
}

Json frame_json(const FrameResult& frame) {
  return {{"time_ms", frame.time_ms},       {"interval_ms", interval_json(frame.interval_ms)},
          {"support", frame.support},       {"error_sources", sources_json(frame.error_sources)},
          {"memory_mib", frame.memory_mib}, {"allocated_mib", frame.allocated_mib},
          {"dram_mb", frame.dram_mb},       {"shaded_samples", frame.shaded_samples}};
}

FrameResult frame_from_json(const Json& json) {
  return {.time_ms = amount(json.at("time_ms")),
          .interval_ms = interval_from_json(json.value("interval_ms", Json())),
          .support = json.value("support", ""),
          .error_sources = sources_from_json(json.value("error_sources", Json::object())),
          .memory_mib = amount(json.at("memory_mib")),
          .allocated_mib = json.value("allocated_mib", 0.0),
          .dram_mb = amount(json.at("dram_mb")),
          .shaded_samples = count(json.at("shaded_samples"))};
}

Json image_json(const std::optional<pipeline::ImageError>& error) {
  if (!error) return nullptr;
  return {{"psnr_db", error->psnr_db},         {"flip_mean", error->flip_mean}, {"rmse", error->rmse},
          {"flip_median", error->flip_median}, {"flip_p99", error->flip_p99},   {"ssim", error->ssim}};
}

std::optional<pipeline::ImageError> image_from_json(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return pipeline::ImageError{.psnr_db = json.at("psnr_db").get<double>(),
                              .rmse = json.at("rmse").get<double>(),
                              .ssim = json.at("ssim").get<double>(),
                              .flip_mean = json.at("flip_mean").get<double>(),
                              .flip_median = json.at("flip_median").get<double>(),
                              .flip_p99 = json.at("flip_p99").get<double>()};
}

/// What the answer took, which no two runs have in common.
void take_effort(const Json& json, Result& result) {
  const Json none = Json::object();
  const Json emulation = json.value("emulation", none), timing = json.value("timing", none);
  result.emulation_wall_s = emulation.value("wall_s", 0.0);
  result.from_cache = emulation.value("from_cache", false);
  result.skipped = named_from_json<std::uint64_t>(emulation.value("skipped", none));
  result.timing_wall_s = timing.value("wall_s", 0.0);
  result.sampling_interval_ms = interval_from_json(timing.value("sampling_interval_ms", Json()));
}

}  // namespace

Result make_result(const PointResult& point, const RunPlan& plan, const std::string& scene_name) {
  Result result{.scene = scene_name,
                .technique = algos::technique_text(*point.technique),
                .gpu = point.gpu->id,
                .engine = std::string(engine_name(plan.engine)),
                .resolution = plan.view.resolution,
                .frame = make_frame(point),
                .image = point.image_error,
                .emulation_wall_s = point.emulation->wall_s,
                .from_cache = point.from_cache,
                .timing_wall_s = point.timing_wall_s,
                .sampling_interval_ms = in_ms(point.timing.sampling_interval_ns)};
  for (std::size_t i = 0; i < point.timing.passes.size(); ++i)
    result.passes.push_back(make_pass(point.timing.passes[i], point.emulation->trace.passes[i]));
  for (const auto& [name, count] : point.emulation->skipped) result.skipped.emplace_back(name, count);
  for (const Diagnostic& warning : result_warnings(point)) result.warnings.push_back(warning.message);
  return result;
}

Json to_json(const Result& result) {
  Json json = {{"schema_version", kResultSchemaVersion},
               {"scene", result.scene},
               {"technique", result.technique},
               {"gpu", result.gpu},
               {"engine", result.engine},
               {"resolution", {result.resolution.width_px, result.resolution.height_px}},
               {"frame", frame_json(result.frame)},
               {"passes", Json::array()},
               {"image", image_json(result.image)},
               {"emulation",
                {{"wall_s", result.emulation_wall_s},
                 {"from_cache", result.from_cache},
                 {"skipped", named_json(result.skipped)}}},
               {"timing", {{"wall_s", result.timing_wall_s}}}};
  for (const PassResult& pass : result.passes) json["passes"].push_back(pass_json(pass));
  for (const std::string& warning : result.warnings) json["warnings"].push_back(warning);
  if (result.sampling_interval_ms)
    json["timing"]["sampling_interval_ms"] = interval_json(result.sampling_interval_ms);
  return json;
}

Result result_from_json(const Json& json) {
  Result result{.scene = json.at("scene").get<std::string>(),
                .technique = json.at("technique").get<std::string>(),
                .gpu = json.at("gpu").get<std::string>(),
                .engine = json.value("engine", ""),
                .frame = frame_from_json(json.at("frame")),
                .image = image_from_json(json.value("image", Json()))};
  if (const auto size = json.find("resolution"); size != json.end())
    result.resolution = {size->at(0).get<int>(), size->at(1).get<int>()};
  for (const Json& pass : json.at("passes")) result.passes.push_back(pass_from_json(pass));
  take_effort(json, result);
  result.warnings = json.value("warnings", std::vector<std::string>{});
  return result;
}

const PassResult* slowest_pass(const Result& result) {
  const auto slowest = std::ranges::max_element(result.passes, {}, &PassResult::time_ms);
  return slowest == result.passes.end() ? nullptr : &*slowest;
}

Json to_json(const Run& run) {
  if (run.results.size() == 1) return to_json(run.results.front());
  Json json = {{"schema_version", kResultSchemaVersion}, {"results", Json::array()}};
  for (const Result& result : run.results) json["results"].push_back(to_json(result));
  return json;
}

Run run_from_json(const Json& json) {
  Run run;
  if (const auto several = json.find("results"); several != json.end())
    for (const Json& result : *several) run.results.push_back(result_from_json(result));
  else
    run.results.push_back(result_from_json(json));
  if (run.results.empty()) return run;
  run.scene = run.results.front().scene;
  run.resolution = run.results.front().resolution;
  return run;
}

}  // namespace hwsim::lab
