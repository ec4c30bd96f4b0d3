#pragma once
// The published cells beside what predicts them: runs, their traces, GPUs and parameters.
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cost_models/parameters.h"
#include "cost_models/published.h"
#include "hwsim/base/diagnostics.h"
#include "hwsim/trace/work_trace.h"

namespace hwsim::cost_models {

/// Emulates a run, or takes it from the cache. Throws InputError when it cannot be done in this version.
using TraceSource = std::function<std::shared_ptr<const WorkTrace>(const RunSpec&, const GpuConfig&)>;

/// One run on one GPU, and the cells that it predicts.
struct Replay {
  RunSpec run;
  std::shared_ptr<const WorkTrace> trace;
  std::shared_ptr<const WorkTrace> unlit;  ///< the same without point lights; none where the run has none
  std::vector<std::uint64_t> pass_keys,
      unlit_pass_keys;             ///< hashes: equal passes are timed once; may be empty
  std::size_t gpu = 0;             ///< index into Experiment::gpus
  std::vector<std::size_t> cells;  ///< indices into Experiment::cells
};

/// Rows that cannot be predicted in this version, never dropped silently.
struct NotRun {
  std::size_t cell = 0;
  std::string reason;  ///< "technique `sss_gs` is missing"
};

struct Experiment {
  std::vector<Cell> cells;  ///< every row of every table
  std::vector<GpuConfig> gpus;
  std::vector<Replay> replays;
  std::vector<FittedParameter> parameters;
  std::vector<NotRun> not_run;
  bool predicted(std::size_t cell) const;  ///< some replay predicts it
  std::size_t gpu_index(const std::string& id) const;
};

using StepProgress = std::function<void(std::size_t done, std::size_t all, const std::string& what)>;

/// Collects the runs of all cells with a use other than claim. `parameters_path` is
/// configs/calibration/parameters.csv.
Experiment make_experiment(std::vector<Cell> cells, const std::map<std::string, GpuConfig>& gpus,
                           const std::string& parameters_path, const TraceSource& traces,
                           const StepProgress& progress);

/// The reason in one line: the first diagnostic of an InputError.
std::string reason_of(const InputError& error);

}  // namespace hwsim::cost_models
