#pragma once
// One function a command, one file a function. Each returns the exit status; bad input is thrown as
// InputError.
#include "cli/arguments/command.h"
#include "cli/terminal/terminal.h"
#include "hwsim/base/diagnostics.h"

namespace hwsim::cli {

ExitStatus run(const RunArguments& options, Context& context);
ExitStatus compare(const CompareArguments& options, Context& context);
ExitStatus explain(const ExplainArguments& options, Context& context);
ExitStatus rank(const RankArguments& options, Context& context);
ExitStatus sweep(const SweepArguments& options, Context& context);
ExitStatus optimize(const OptimizeArguments& options, Context& context);
ExitStatus report(const ReportArguments& options, Context& context);
ExitStatus reference(const ReferenceArguments& options, Context& context);
ExitStatus list(const ListArguments& options, Context& context);
ExitStatus show_entry(const ShowArguments& options, Context& context);
ExitStatus scene_check(const SceneCheckArguments& options, Context& context);
ExitStatus config(const ConfigArguments& options, Context& context);
ExitStatus gpu_new(const GpuNewArguments& options, Context& context);
ExitStatus doctor(const DoctorArguments& options, Context& context);
ExitStatus help(const HelpArguments& options, Context& context);
ExitStatus cache(const CacheArguments& options, Context& context);
ExitStatus fit(const FitArguments& options, Context& context);
ExitStatus validate(const ValidateArguments& options, Context& context);
ExitStatus reproduce(const ReproduceArguments& options, Context& context);
ExitStatus completion(const CompletionArguments& options, Context& context);

}  // namespace hwsim::cli
