#pragma once
// Why a frame takes its time: what each unit's share is, what the frame would gain without a unit's work, and
// how much each number of the GPU matters.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/studies/comparison.h"

namespace hwsim::lab {

struct UnitHeadroomResult {
  std::string unit{};
  double time_ms = 0.0;  ///< the frame's time if the unit took none
};

struct SensitivityResult {
  std::string parameter{};  ///< "gpu.core_clock_mhz"
  double value = 0.0;
  double slope_ms = 0.0;    ///< d(frame time) / d(value)
  double elasticity = 0.0;  ///< percent of time a percent of value; negative: more of it is faster
  std::optional<double>
      doubled_ms{};  ///< the frame's time with twice the value; none outside the key's range
};

struct Explanation {
  Result result{};
  std::vector<NamedValues<double>> stack_ms{};     ///< for each pass, exclusive shares of its time by unit
  std::vector<UnitHeadroomResult> headroom{};      ///< the largest gain first
  std::vector<SensitivityResult> sensitivities{};  ///< the largest elasticity first
  /// The frame's time by the engine that has derivatives: that of the result, but `queue` for `detailed`,
  /// whose events have none.
  double analyzed_ms = 0.0;
};

Explanation explain(const PointResult& point, const RunPlan& plan, const std::string& scene_name);

nlohmann::ordered_json to_json(const Explanation& explanation);
/// Throws nlohmann::json::exception where a field is missing or of another type.
Explanation explanation_from_json(const nlohmann::ordered_json& json);

/// The answer of a run: one explanation alone, or all in "results" and what they differ in. `calibration` may
/// be null: no intervals of differences.
nlohmann::ordered_json to_json(const std::vector<Explanation>& explanations,
                               const cost_models::Calibration* calibration);

/// The passes: limiter, time stack, busiest units.
Table explained_passes(const Explanation& explanation);
Table headroom_table(const Explanation& explanation);
/// Parameters without influence are left out unless `every` is set.
Table sensitivity_table(const Explanation& explanation, bool every);

/// "msaa4x on gtx980".
std::string label_of(const Explanation& explanation);

/// The first explanation against the others; there must be one. `calibration` may be null.
Comparison compare(const std::vector<Explanation>& explanations, const cost_models::Calibration* calibration);

/// The share of the slowest pass's time that goes to its limiter, 0 to 1.
double limiter_share_ratio(const Explanation& explanation);

}  // namespace hwsim::lab
