#include "lab/studies/comparison.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

#include "hwsim/base/units_of_measure.h"
#include "hwsim/gpu/gpu_keys.h"

namespace hwsim::lab {
namespace {

using Json = nlohmann::ordered_json;

const PassResult* find_pass(const Result& result, const std::string& name) {
  const auto found = std::ranges::find(result.passes, name, &PassResult::name);
  return found == result.passes.end() ? nullptr : &*found;
}

template <class T>
T value_of(const NamedValues<T>& values, const std::string& name) {
  for (const auto& [key, value] : values)
    if (key == name) return value;
  return T{};
}

double dram_mb(const PassResult* pass) {
  double bytes = 0.0;
  if (pass)
    for (const auto& [stream, value] : pass->bytes) bytes += value;
  return bytes / kBytesPerMb;
}

/// Names of all passes of two results: in the order of the first, those that only the second has where they
/// stand there.
std::vector<std::string> pass_names(const Result& before, const Result& after) {
  std::vector<std::string> names;
  for (const PassResult& pass : before.passes) names.push_back(pass.name);
  auto place = names.begin();
  for (const PassResult& pass : after.passes) {
    const auto known = std::find(names.begin(), names.end(), pass.name);
    place = (known != names.end() ? known : names.insert(place, pass.name)) + 1;
  }
  return names;
}

PassDifference pass_difference(const std::string& name, const PassResult* before, const PassResult* after) {
  const PassResult nothing;
  const PassResult& old = before ? *before : nothing;
  const PassResult& now = after ? *after : nothing;
  PassDifference difference{
      .name = name, .time_ms = {old.time_ms, now.time_ms}, .dram_mb = {dram_mb(before), dram_mb(after)}};
  if (before) difference.limiter.before = old.limiter;
  if (after) difference.limiter.after = now.limiter;
  for (const auto& [stream, unused] : (after ? now : old).bytes)
    difference.bytes.emplace_back(stream,
                                  Change<double>{value_of(old.bytes, stream), value_of(now.bytes, stream)});
  for (const auto& [id, unused] : (after ? now : old).counters)
    if (const Change<std::uint64_t> change{value_of(old.counters, id), value_of(now.counters, id)};
        change.before != change.after)
      difference.counters.emplace_back(id, change);
  return difference;
}

Support support_of(const FrameResult& frame) {
  for (const Support support : {Support::calibrated, Support::interpolated, Support::extrapolated})
    if (frame.interval_ms && frame.support == support_name(support)) return support;
  return Support::uncalibrated;
}

Difference difference_of(const LabeledResult& before, const LabeledResult& after,
                         const cost_models::Calibration* calibration) {
  const Result &base = before.result, &result = after.result;
  const FrameResult &old = base.frame, &now = result.frame;
  Difference difference{
      .label = after.label,
      .variation = after.variation,
      .scene = result.scene,
      .technique = result.technique,
      .gpu = result.gpu,
      .base = before.label,
      .time_ms = {old.time_ms, now.time_ms},
      .memory_mib = {old.memory_mib, now.memory_mib},
      .dram_mb = {old.dram_mb, now.dram_mb},
      .shaded_samples = {static_cast<double>(old.shaded_samples), static_cast<double>(now.shaded_samples)}};
  const bool same_frame =
      before.gpu && after.gpu && before.view == after.view && base.technique == result.technique;
  if (calibration)
    difference.time_change_interval = time_change_interval(
        base, result, *calibration, same_frame ? time_direction(*before.gpu, *after.gpu) : 0);
  for (const std::string& name : pass_names(base, result))
    difference.passes.push_back(pass_difference(name, find_pass(base, name), find_pass(result, name)));
  return difference;
}

Json to_json(const Change<double>& change) {
  const auto ratio = relative_change(change.before, change.after);
  return {{"before", change.before},
          {"after", change.after},
          {"delta_ratio", ratio ? Json(*ratio) : Json(nullptr)}};
}

Json to_json(const Change<std::uint64_t>& change) {
  return {{"before", change.before}, {"after", change.after}};
}

Json to_json(const Change<std::optional<std::string>>& change) {
  const auto side = [](const std::optional<std::string>& name) { return name ? Json(*name) : Json(nullptr); };
  return {{"before", side(change.before)}, {"after", side(change.after)}};
}

template <class T>
Json to_json(const NamedValues<Change<T>>& changes) {
  Json json = Json::object();
  for (const auto& [name, change] : changes) json[name] = to_json(change);
  return json;
}

Json to_json(const PassDifference& pass) {
  return {{"name", pass.name},
          {"time_ms", to_json(pass.time_ms)},
          {"limiter", to_json(pass.limiter)},
          {"dram_mb", to_json(pass.dram_mb)},
          {"bytes", to_json(pass.bytes)},
          {"counters", to_json(pass.counters)}};
}

Json to_json(const Difference& difference) {
  Json time = to_json(difference.time_ms);
  const auto& interval = difference.time_change_interval;
  time["delta_interval90"] = interval ? Json{(*interval)[0], (*interval)[1]} : Json(nullptr);
  Json json = {{"label", difference.label},
               {"variation", difference.variation},
               {"base", difference.base},
               {"scene", difference.scene},
               {"technique", difference.technique},
               {"gpu", difference.gpu},
               {"frame",
                {{"time_ms", time},
                 {"memory_mib", to_json(difference.memory_mib)},
                 {"dram_mb", to_json(difference.dram_mb)},
                 {"shaded_samples", to_json(difference.shaded_samples)}}},
               {"passes", Json::array()}};
  for (const PassDifference& pass : difference.passes) json["passes"].push_back(to_json(pass));
  return json;
}

template <class T>
Change<T> change_from_json(const Json& json) {
  return {json.at("before").get<T>(), json.at("after").get<T>()};
}

template <class T>
NamedValues<Change<T>> changes_from_json(const Json& json) {
  NamedValues<Change<T>> changes;
  for (const auto& [name, change] : json.items()) changes.emplace_back(name, change_from_json<T>(change));
  return changes;
}

std::optional<std::string> side_from_json(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<std::string>());
}

PassDifference pass_difference_from_json(const Json& json) {
  const Json& limiter = json.at("limiter");
  return {.name = json.at("name").get<std::string>(),
          .time_ms = change_from_json<double>(json.at("time_ms")),
          .dram_mb = change_from_json<double>(json.at("dram_mb")),
          .limiter = {side_from_json(limiter.at("before")), side_from_json(limiter.at("after"))},
          .bytes = changes_from_json<double>(json.at("bytes")),
          .counters = changes_from_json<std::uint64_t>(json.at("counters"))};
}

Difference difference_from_json(const Json& json) {
  const Json& frame = json.at("frame");
  Difference difference{.label = json.at("label").get<std::string>(),
                        .variation = json.value("variation", ""),
                        .scene = json.at("scene").get<std::string>(),
                        .technique = json.at("technique").get<std::string>(),
                        .gpu = json.at("gpu").get<std::string>(),
                        .base = json.value("base", ""),
                        .time_ms = change_from_json<double>(frame.at("time_ms")),
                        .memory_mib = change_from_json<double>(frame.at("memory_mib")),
                        .dram_mb = change_from_json<double>(frame.at("dram_mb")),
                        .shaded_samples = change_from_json<double>(frame.at("shaded_samples"))};
  if (const Json interval = frame.at("time_ms").value("delta_interval90", Json()); !interval.is_null())
    difference.time_change_interval = {interval.at(0).get<double>(), interval.at(1).get<double>()};
  for (const Json& pass : json.at("passes")) difference.passes.push_back(pass_difference_from_json(pass));
  return difference;
}

}  // namespace

std::optional<double> relative_change(double before, double after) {
  if (before == after) return 0.0;
  if (before == 0.0) return std::nullopt;
  return (after - before) / std::abs(before);
}

double shared_time_ms(const Result& before, const Result& after) {
  if (before.gpu != after.gpu || before.scene != after.scene || before.resolution != after.resolution)
    return 0.0;
  double shared_ms = 0.0;
  for (const PassResult& pass : before.passes)
    if (const PassResult* other = find_pass(after, pass.name); other && other->time_ms == pass.time_ms)
      shared_ms += pass.time_ms;
  return std::min({shared_ms, before.frame.time_ms, after.frame.time_ms});
}

std::optional<double> ratio_log_width(const Result& before, const Result& after,
                                      const cost_models::Calibration& calibration) {
  const cost_models::Likeness likeness{
      .technique = before.technique == after.technique,
      .gpu = before.gpu == after.gpu,
      .scene = before.scene == after.scene && before.resolution == after.resolution,
      .support = std::max(support_of(before.frame), support_of(after.frame))};
  const std::optional<double> half = cost_models::ratio_half_width(calibration, before.frame.error_sources,
                                                                   after.frame.error_sources, likeness);
  return half ? std::optional(std::log(*half)) : std::nullopt;
}

int time_direction(const GpuConfig& before, const GpuConfig& after) {
  if (functional_hash(before) != functional_hash(after)) return 0;
  GpuConfig old = before, now = after;
  const std::vector<Key> was = keys_of(static_cast<GpuValues<double>&>(old));
  const std::vector<Key> is = keys_of(static_cast<GpuValues<double>&>(now));
  bool longer = false, shorter = false;
  for (std::size_t i = 0; i < was.size(); ++i) {
    const auto number = [](const Key& key) {
      return std::visit(
          [](const auto* value) {
            if constexpr (std::is_arithmetic_v<std::remove_reference_t<decltype(*value)>>)
              return static_cast<double>(*value);
            return 0.0;
          },
          key.slot);
    };
    const double change = number(is[i]) - number(was[i]);
    if (change == 0.0) continue;
    const bool faster = was[i].info.has(kFaster), slower = was[i].info.has(kSlower);
    if (!faster && !slower) return 0;
    (faster == (change > 0.0) ? shorter : longer) = true;
  }
  return longer == shorter ? 0 : longer ? 1 : -1;
}

std::optional<std::array<double, 2>> time_change_interval(const Result& before, const Result& after,
                                                          const cost_models::Calibration& calibration,
                                                          int direction) {
  const std::optional<double> width = ratio_log_width(before, after, calibration);
  if (!width || before.frame.time_ms <= 0.0) return std::nullopt;
  const double shared_ms = before.technique == after.technique ? 0.0 : shared_time_ms(before, after);
  const auto end = [&](double factor) {
    return (shared_ms + (after.frame.time_ms - shared_ms) * factor) / before.frame.time_ms - 1.0;
  };
  std::array ends{end(std::exp(-*width)), end(std::exp(*width))};
  // Half the DRAM makes no frame faster, however little is known of it.
  if (direction > 0 && end(1.0) >= 0.0) ends[0] = std::max(0.0, ends[0]);
  if (direction < 0 && end(1.0) <= 0.0) ends[1] = std::min(0.0, ends[1]);
  return ends;
}

Comparison compare(const std::vector<LabeledResult>& results, const cost_models::Calibration* calibration) {
  Comparison comparison{results.front().label, results.front().result, {}};
  for (std::size_t i = 1; i < results.size(); ++i) {
    const LabeledResult& after = results[i];
    const auto own = std::ranges::find_if(results, [&](const LabeledResult& before) {
      return before.result.technique == after.result.technique && before.result.gpu == after.result.gpu;
    });
    const LabeledResult& before = &*own == &after ? results.front() : *own;
    comparison.differences.push_back(difference_of(before, after, calibration));
  }
  return comparison;
}

Json to_json(const Comparison& comparison) {
  Json json = {{"schema_version", kResultSchemaVersion},
               {"baseline", {{"label", comparison.baseline_label}, {"result", to_json(comparison.baseline)}}},
               {"results", Json::array()}};
  for (const Difference& difference : comparison.differences) json["results"].push_back(to_json(difference));
  return json;
}

Comparison comparison_from_json(const Json& json) {
  const Json& baseline = json.at("baseline");
  Comparison comparison{baseline.at("label").get<std::string>(), result_from_json(baseline.at("result")), {}};
  for (const Json& difference : json.at("results"))
    comparison.differences.push_back(difference_from_json(difference));
  return comparison;
}

}  // namespace hwsim::lab
