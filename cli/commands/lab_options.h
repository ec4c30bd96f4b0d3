#pragma once
// What the environment and the flags say of the lab that does the work.
#include "cli/arguments/command.h"
#include "cli/terminal/terminal.h"
#include "lab/lab.h"

namespace hwsim::cli {

/// `log` must outlive the lab. Throws InputError U017.
inline LabOptions lab_options(const CommonArguments& common, Log& log) {
  LabOptions options = options_of_environment();
  options.jobs = common.jobs;
  options.observer = &log;
  return options;
}

inline LabOptions lab_options(const RunArguments& run, Log& log) {
  LabOptions options = lab_options(run.common, log);
  options.use_cache = !run.no_cache;
  return options;
}

}  // namespace hwsim::cli
