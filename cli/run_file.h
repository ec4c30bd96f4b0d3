#pragma once
// run.toml: a run with every value decided. `hwsim run run.toml` gives the same numbers again.
#include <string>

#include "cli/plan.h"

namespace hwsim::cli {

struct RunFile {
  ViewPlan view;
  std::string technique = "none";
  std::string gpu = "gtx980";  ///< an id, or the path of a file
  std::string engine = "queue";
  double detailed_sample = 1.0;
  std::string skip = "all";
  int reference_samples = 0;
};

/// Throws InputError with every problem in the file. Paths in it are relative to the file.
RunFile read_run_file(const std::string& path);

/// "all", "none", or the names of those that are on.
std::string skip_text(const pipeline::SkipSwitches& skip);

/// The text of a run.toml for one point of a plan; `gpu_file` stands beside it.
std::string run_file_text(const RunPlan& plan, const algos::TechniqueChoice& technique,
                          const std::string& gpu_file);

}  // namespace hwsim::cli
