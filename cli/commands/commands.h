#pragma once
// One function a command, one file a function. Each returns the exit status; bad input is thrown as
// InputError.
#include "cli/arguments/options.h"
#include "cli/terminal/terminal.h"
#include "hwsim/base/diagnostics.h"

namespace hwsim::cli {

ExitStatus run(const RunOptions& options, Context& context);
ExitStatus compare(const CompareOptions& options, Context& context);
ExitStatus explain(const ExplainOptions& options, Context& context);
ExitStatus rank(const RankOptions& options, Context& context);
ExitStatus sweep(const SweepOptions& options, Context& context);
ExitStatus reference(const ReferenceOptions& options, Context& context);
ExitStatus list(const ListOptions& options, Context& context);
ExitStatus show_entry(const ShowOptions& options, Context& context);
ExitStatus scene_check(const SceneCheckOptions& options, Context& context);
ExitStatus config(const ConfigOptions& options, Context& context);
ExitStatus doctor(const DoctorOptions& options, Context& context);
ExitStatus help(const HelpOptions& options, Context& context);
ExitStatus cache(const CacheOptions& options, Context& context);
ExitStatus fit(const FitOptions& options, Context& context);
ExitStatus validate(const ValidateOptions& options, Context& context);
ExitStatus reproduce(const ReproduceOptions& options, Context& context);
ExitStatus completion(const CompletionOptions& options, Context& context);

}  // namespace hwsim::cli
