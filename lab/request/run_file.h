#pragma once
// run.toml: a run with every value decided. `hwsim run run.toml` gives the same numbers again.
#include <string>

#include "lab/request/plan.h"
#include "lab/request/request.h"

namespace hwsim::lab {

/// Throws InputError with every problem in the file. Paths in it are relative to the file.
Request read_run_file(const std::string& path);

/// The text of a run.toml for one point of a plan; `gpu_file` stands beside it.
std::string run_file_text(const RunPlan& plan, const algos::TechniqueChoice& technique,
                          const std::string& gpu_file);

/// JSON Schema (draft 2020-12) of a run.toml.
std::string run_schema_json();

}  // namespace hwsim::lab
