#pragma once
// From flags to what is asked of the lab.
#include "cli/arguments/command.h"
#include "lab/lab.h"

namespace hwsim::cli {

/// A run.toml or defaults, then `--set`, then flags. Throws InputError with every problem found.
lab::Request request_of(const RunArguments& options);
lab::RunPlan plan_of(const RunArguments& options, lab::Lab& lab);

/// "path=value" each. Throws InputError with every problem found.
std::vector<Assignment> parse_sets(const std::vector<std::string>& texts);

/// Only scene.* may be set.
lab::View view_of(const ViewArguments& options);

}  // namespace hwsim::cli
