#pragma once
// Results side by side: the first is the baseline. What is compared is the JSON of a result, so that a run
// that was just made and one read from a folder are the same thing.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/base/table.h"

namespace hwsim::lab {

struct ComparedResult {
  std::string label;  ///< "baseline", "rops-x2", "runs/a"
  nlohmann::ordered_json result;
};

/// (new - old) / |old|; none where old is 0 and new is not.
std::optional<double> relative_change(double before, double after);

/// One row a result: time, change, limiter, bytes, memory, shaded samples.
Table frame_comparison(const std::vector<ComparedResult>& results);

/// One row a result (but the baseline) and pass: times, limiters and bytes before and after. Passes are
/// matched by name; one that only one side has is compared with nothing.
Table pass_comparison(const std::vector<ComparedResult>& results);

/// One row a result, pass and counter that changed.
Table counter_comparison(const std::vector<ComparedResult>& results);

/// Everything of the three tables, and bytes by stream.
nlohmann::ordered_json comparison_json(const std::vector<ComparedResult>& results);

/// Results in a folder that `run` wrote: one, or one for each point. Throws InputError U020.
std::vector<ComparedResult> read_results(const std::string& path);

}  // namespace hwsim::lab
