#pragma once
// What the flags of a run say of the lab that does it.
#include "cli/arguments/options.h"
#include "cli/terminal/terminal.h"
#include "lab/lab.h"

namespace hwsim::cli {

/// `log` must outlive the lab.
inline LabOptions lab_options(const RunOptions& options, Log& log) {
  return {.jobs = options.common.jobs, .use_cache = !options.no_cache, .observer = &log};
}

}  // namespace hwsim::cli
