#pragma once
// From flags to what is asked of the lab.
#include "cli/arguments/options.h"
#include "lab/request/plan.h"

namespace hwsim::cli {

/// A run.toml or defaults, then `--set`, then flags. Throws InputError with every problem found.
lab::Request request_of(const RunOptions& options);
lab::RunPlan plan_of(const RunOptions& options);
/// The same, with files that are kept from one plan to the next.
lab::RunPlan plan_of(const RunOptions& options, lab::ConfigFiles& files);

/// Only scene.* may be set.
lab::View view_of(const ViewOptions& options);

}  // namespace hwsim::cli
