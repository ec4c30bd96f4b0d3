#pragma once
// Results side by side: each is what changed against its own technique before, or against the first. A result
// that was just made and one read from a folder are the same thing.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/base/table.h"
#include "lab/results/result.h"

namespace hwsim::lab {

struct LabeledResult {
  std::string label{};  ///< "baseline", "msaa4x on gtx980 rops-x2", "runs/a"
  Result result{};
  std::string variation{};         ///< "rops-x2"; empty: as asked for
  std::optional<GpuConfig> gpu{};  ///< that timed it; none: read from a folder
  std::size_t view = 0;            ///< results of one technique with the same number are of one frame
};

/// What the documents of the keys say that a change of a GPU's numbers does to every time: -1 never longer, 1
/// never shorter, 0 both ways, or it changes the work.
int time_direction(const GpuConfig& before, const GpuConfig& after);

/// (new - old) / |old|; none where old is 0 and new is not.
std::optional<double> relative_change(double before, double after);

template <class T>
struct Change {
  T before{}, after{};
};

/// Passes are matched by name; one that only one side has is compared with nothing.
struct PassDifference {
  std::string name{};
  Change<double> time_ms{}, dram_mb{};
  Change<std::optional<std::string>> limiter{};   ///< none: this side has no such pass
  NamedValues<Change<double>> bytes{};            ///< by stream
  NamedValues<Change<std::uint64_t>> counters{};  ///< those that changed
};

struct Difference {
  std::string label{}, variation{}, scene{}, technique{}, gpu{};
  std::string base{};  ///< label of the result that it is held against
  Change<double> time_ms{}, memory_mib{}, dram_mb{}, shaded_samples{};
  /// 90 % interval of the relative change of the time; none without a calibration. It is narrower than those
  /// of the times, since what is wrong with both cancels.
  std::optional<std::array<double, 2>> time_change_interval{};
  std::vector<PassDifference> passes{};  ///< in the order of the baseline, new ones where they stand
};

struct Comparison {
  std::string baseline_label{};
  Result baseline{};
  std::vector<Difference> differences{};  ///< one a result behind the first
};

/// Compares each result with the first one of its own technique on its GPU, and the first of each with the
/// first of all; there must be one. `calibration` may be null: no intervals.
Comparison compare(const std::vector<LabeledResult>& results, const cost_models::Calibration* calibration);

/// What passes take that both frames have alike: two techniques' shadow map, or all that comes before a
/// filter. 0 for other GPUs, scenes or sizes.
double shared_time_ms(const Result& before, const Result& after);

/// The logarithm of the factor from a ratio of two times to the ends of its 90 % interval; none without
/// intervals of both.
std::optional<double> ratio_log_width(const Result& before, const Result& after,
                                      const cost_models::Calibration& calibration);

/// 90 % interval of the relative change of the time from one result to another; none without intervals of
/// both. Of two techniques, what passes take that both have alike is as wrong in both. Of one frame on
/// changed hardware, `direction` says on which side of nothing the change lies (time_direction).
std::optional<std::array<double, 2>> time_change_interval(const Result& before, const Result& after,
                                                          const cost_models::Calibration& calibration,
                                                          int direction = 0);

nlohmann::ordered_json to_json(const Comparison& comparison);
/// Throws nlohmann::json::exception where a field is missing or of another type.
Comparison comparison_from_json(const nlohmann::ordered_json& json);

/// One row a result, the baseline first: time, change, limiter, bytes, memory, shaded samples.
Table frame_comparison(const Comparison& comparison);

/// Techniques by variations: what each variation does to the time, "+73 % [+66, +81]". No rows without
/// variations.
Table variation_matrix(const Comparison& comparison);

/// One row a difference and pass: times, limiters and bytes before and after; those that change alone, or
/// `all`.
Table pass_comparison(const Comparison& comparison, bool all = false);

/// One row a difference, pass and counter that changed.
Table counter_comparison(const Comparison& comparison);

/// Whether a name is one of results that were written: a folder, or a result.json.
bool is_result(const std::string& name);

/// Results in a folder that `run` wrote: one, or one for each point. Throws InputError U020.
std::vector<LabeledResult> read_results(const std::string& path);

/// Compares the results in the folders. Throws InputError U002 when there is one alone.
Comparison compare_results(const std::vector<std::string>& paths,
                           const cost_models::Calibration* calibration);

}  // namespace hwsim::lab
