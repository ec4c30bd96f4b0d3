#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "lab/results/result.h"
#include "lab/studies/optimize.h"

namespace hwsim::lab {
namespace {

constexpr double kPercent = 100.0;

TableCell bound(const OptimizedFrame& frame, std::size_t end) {
  return frame.interval_ms ? TableCell{Real{(*frame.interval_ms)[end], 4}} : TableCell{NotApplicable{}};
}

std::string time_text(const OptimizedFrame& frame) {
  std::string text = fmt::format("{:.4f} ms", frame.time_ms);
  if (frame.interval_ms)
    text += fmt::format(" [{:.4f}, {:.4f}]", (*frame.interval_ms)[0], (*frame.interval_ms)[1]);
  return text + " " + frame.support;
}

std::string beyond(double value, double limit) {
  return fmt::format("{:.1f} %", kPercent * (value / limit - 1.0));
}

std::string missed(const Optimization& found) {
  const OptimizedGpu& best = *found.best;
  if (found.goal.time_ms)
    return fmt::format(
        "No GPU within the bounds draws every frame in {} ms: the fastest takes {}, {} more, for an area of "
        "{:.1f}",
        exact(*found.goal.time_ms), time_text(best.frames[best.slowest]),
        beyond(best.time_ms(), *found.goal.time_ms), best.area);
  return fmt::format(
      "No GPU within the bounds has an area of {}: the smallest has {:.1f}, {} more, and takes {}",
      exact(*found.goal.area), best.area, beyond(best.area, *found.goal.area),
      time_text(best.frames[best.slowest]));
}

/// "lower" or "upper" where a value stands at an end of what it may be; the last step may be short of `high`.
std::string_view bound_of(const PricedKey& key, double value) {
  constexpr double kNear = 1e-6;
  const double highest = key.step > 0.0 ? key.high - key.step : key.high;
  if (value <= key.low * (1.0 + kNear)) return "lower";
  const bool is_last = key.step > 0.0 ? value > highest * (1.0 + kNear) : value >= highest * (1.0 - kNear);
  return is_last ? "upper" : "";
}

nlohmann::ordered_json bounds_of(const OptimizedGpu& gpu, const std::vector<PricedKey>& keys) {
  nlohmann::ordered_json bounds = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (const std::string_view bound = bound_of(keys[i], gpu.values[i]); !bound.empty())
      bounds[keys[i].key] = bound;
  return bounds;
}

nlohmann::ordered_json json_of(const OptimizedGpu& gpu, const std::vector<PricedKey>& keys) {
  nlohmann::ordered_json values = nlohmann::ordered_json::object(), frames = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < keys.size(); ++i) values[keys[i].key] = gpu.values[i];
  for (const OptimizedFrame& frame : gpu.frames) {
    nlohmann::ordered_json& json = frames.emplace_back(nlohmann::ordered_json{{"name", frame.name},
                                                                              {"time_ms", frame.time_ms},
                                                                              {"interval_ms", nullptr},
                                                                              {"support", frame.support},
                                                                              {"limiter", frame.limiter}});
    if (frame.interval_ms) json["interval_ms"] = *frame.interval_ms;
  }
  return {{"area", gpu.area}, {"time_ms", gpu.time_ms()}, {"values", values}, {"frames", frames}};
}

}  // namespace

std::string answer_of(const Optimization& found) {
  if (!found.best) return fmt::format("{} GPUs that nobody beats in area and time", found.front.size());
  if (!found.met) return missed(found);
  const OptimizedGpu& best = *found.best;
  const std::string time = time_text(best.frames[best.slowest]);
  const std::string what =
      found.goal.time_ms
          ? fmt::format("The smallest GPU that draws every frame in {} ms", exact(*found.goal.time_ms))
          : fmt::format("The fastest GPU of an area of {} at most", exact(*found.goal.area));
  return fmt::format("{} has an area of {:.1f} ({} unchanged: {:.1f}) and takes {} ({:.4f} ms unchanged){}",
                     what, best.area, found.gpu, found.unchanged.area, time, found.unchanged.time_ms(),
                     found.verdict == "ok" ? "" : "; " + found.verdict);
}

Table optimized_keys(const Optimization& found) {
  Table table{{{"key", "key"},
               {"unchanged", "unchanged", true},
               {"best", "best", true},
               {"low", "from", true},
               {"high", "to", true},
               {"step", "step", true},
               {"area", "area", true},
               {"bound", "ended"}},
              {}};
  for (std::size_t i = 0; found.best && i < found.keys.size(); ++i) {
    const PricedKey& key = found.keys[i];
    const double best = found.best->values[i];
    const std::string_view bound = bound_of(key, best);
    table.rows.push_back({key.key, Real{found.unchanged.values[i], 2}, Real{best, 2}, Real{key.low, 2},
                          Real{key.high, 2}, Real{key.step, 2}, Real{key.area * best, 1},
                          bound.empty() ? "" : fmt::format("on its {} bound", bound)});
  }
  return table;
}

Table optimized_front(const Optimization& found) {
  Table table{{{"area", "area", true},
               {"time_ms", "ms", true},
               {"lo_ms", "lo", true},
               {"hi_ms", "hi", true},
               {"support", "support"},
               {"slowest", "slowest frame"},
               {"limiter", "limiter"}},
              {}};
  for (const PricedKey& key : found.keys) table.columns.push_back({key.key, key.key, true});
  for (const OptimizedGpu& gpu : found.front) {
    const OptimizedFrame& frame = gpu.frames[gpu.slowest];
    std::vector<TableCell>& row = table.rows.emplace_back(
        std::vector<TableCell>{Real{gpu.area, 1}, Real{frame.time_ms, 4}, bound(frame, 0), bound(frame, 1),
                               frame.support, frame.name, frame.limiter});
    for (const double value : gpu.values) row.emplace_back(Real{value, 2});
  }
  return table;
}

Table optimized_frames(const Optimization& found) {
  Table table{{{"frame", "frame"},
               {"unchanged_ms", "unchanged ms", true},
               {"time_ms", "ms", true},
               {"lo_ms", "lo", true},
               {"hi_ms", "hi", true},
               {"support", "support"},
               {"limiter", "limiter"}},
              {}};
  for (std::size_t i = 0; found.best && i < found.best->frames.size(); ++i) {
    const OptimizedFrame& frame = found.best->frames[i];
    table.rows.push_back({frame.name, Real{found.unchanged.frames[i].time_ms, 4}, Real{frame.time_ms, 4},
                          bound(frame, 0), bound(frame, 1), frame.support, frame.limiter});
  }
  return table;
}

nlohmann::ordered_json to_json(const Optimization& found) {
  nlohmann::ordered_json json = {{"schema_version", kResultSchemaVersion},
                                 {"gpu", found.gpu},
                                 {"prices", found.prices},
                                 {"answer", answer_of(found)}};
  if (found.goal.time_ms) json["time_limit_ms"] = *found.goal.time_ms;
  if (found.goal.area) json["area_limit"] = *found.goal.area;
  json["unchanged"] = json_of(found.unchanged, found.keys);
  if (found.best) {
    json["met"] = found.met;
    json["verdict"] = found.verdict;
    json["best"] = json_of(*found.best, found.keys);
    json["best"]["bounds"] = bounds_of(*found.best, found.keys);
    nlohmann::ordered_json settings = nlohmann::ordered_json::object();
    for (const Assignment& set : found.settings) settings[set.path] = set.value;
    json["settings"] = settings;
  }
  json["front"] = nlohmann::ordered_json::array();
  for (const OptimizedGpu& gpu : found.front) json["front"].push_back(json_of(gpu, found.keys));
  json["replays"] = found.replays;
  return json;
}

}  // namespace hwsim::lab
