#pragma once
// The result of a point as plain data: what result.json holds (docs/results.md), without a sentence. Whoever
// reads a file and whoever just ran the point have the same thing in hand.
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lab/point/simulate.h"

namespace hwsim::lab {

inline constexpr int kResultSchemaVersion = 1;

/// Values by name, in the order in which they are shown.
template <class T>
using NamedValues = std::vector<std::pair<std::string, T>>;

struct PassResult {
  std::string name{}, kind{};
  double time_ms = 0.0;
  std::string limiter{};                  ///< the unit that bounds the pass
  NamedValues<double> units{};            ///< busy part of the pass's time by unit, 0 to 1
  NamedValues<double> bytes{};            ///< DRAM bytes, read and written, by stream
  NamedValues<std::uint64_t> counters{};  ///< by the counter's id
};

struct FrameResult {
  double time_ms = 0.0;
  std::optional<std::array<double, 2>> interval_ms{};  ///< 90 %; none without a calibration
  std::string support{};
  cost_models::ErrorSources error_sources{};  ///< empty without an interval
  double memory_mib = 0.0;                    ///< the most that is alive at once
  double allocated_mib = 0.0;                 ///< all attachments
  double dram_mb = 0.0;
  std::uint64_t shaded_samples = 0;
};

struct Result {
  std::string scene{}, technique{}, gpu{}, engine{};
  Resolution resolution{};
  FrameResult frame{};
  std::vector<PassResult> passes{};
  std::optional<pipeline::ImageError> image{};  ///< against the reference; none without one
  double emulation_wall_s = 0.0;
  bool from_cache = false;               ///< the work was counted before, by this run or an earlier one
  NamedValues<std::uint64_t> skipped{};  ///< shader invocations and the like that the emulator left out
  double timing_wall_s = 0.0;
  std::optional<std::array<double, 2>> sampling_interval_ms{};  ///< engine detailed, when it samples
  std::vector<std::string> warnings{};
};

Result make_result(const PointResult& point, const RunPlan& plan, const std::string& scene_name);

nlohmann::ordered_json to_json(const Result& result);

/// Unknown fields are ignored. Throws nlohmann::json::exception where a field is missing or of another type.
Result result_from_json(const nlohmann::ordered_json& json);

/// The slowest pass, the first of equals; null without passes.
const PassResult* slowest_pass(const Result& result);

/// The results of a run, in the order of its plan.
struct Run {
  std::string scene{};
  Resolution resolution{};
  std::vector<Result> results{};
};

/// One result alone, or all of them in "results".
nlohmann::ordered_json to_json(const Run& run);
Run run_from_json(const nlohmann::ordered_json& json);

}  // namespace hwsim::lab
