#pragma once
// Results side by side: the first is the baseline, and each other one is what changed against it. A result
// that was just made and one read from a folder are the same thing.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/base/table.h"
#include "lab/results/result.h"

namespace hwsim::lab {

struct LabeledResult {
  std::string label{};  ///< "baseline", "rops-x2", "runs/a"
  Result result{};
};

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
  std::string label{}, scene{}, technique{}, gpu{};
  Change<double> time_ms{}, memory_mib{}, dram_mb{}, shaded_samples{};
  std::vector<PassDifference> passes{};  ///< in the order of the baseline, new ones where they stand
};

struct Comparison {
  std::string baseline_label{};
  Result baseline{};
  std::vector<Difference> differences{};  ///< one a result behind the first
};

/// Compares all with the first; there must be one.
Comparison compare(const std::vector<LabeledResult>& results);

nlohmann::ordered_json to_json(const Comparison& comparison);
/// Throws nlohmann::json::exception where a field is missing or of another type.
Comparison comparison_from_json(const nlohmann::ordered_json& json);

/// One row a result, the baseline first: time, change, limiter, bytes, memory, shaded samples.
Table frame_comparison(const Comparison& comparison);

/// One row a difference and pass: times, limiters and bytes before and after.
Table pass_comparison(const Comparison& comparison);

/// One row a difference, pass and counter that changed.
Table counter_comparison(const Comparison& comparison);

/// Whether a name is one of results that were written: a folder, or a result.json.
bool is_result(const std::string& name);

/// Results in a folder that `run` wrote: one, or one for each point. Throws InputError U020.
std::vector<LabeledResult> read_results(const std::string& path);

/// Compares all results in the folders with the first. Throws InputError U002 when there is one alone.
Comparison compare_results(const std::vector<std::string>& paths);

}  // namespace hwsim::lab
