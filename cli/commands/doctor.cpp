#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"

namespace hwsim::cli {

ExitStatus doctor(const DoctorArguments& options, Context& context) {
  const std::vector<SelfCheck> checks = Lab(lab_options(options.common, context.log)).check_itself();
  ExitStatus status = ExitStatus::done;
  for (const SelfCheck& check : checks) {
    for (const Diagnostic& problem : check.problems) context.log.report(problem);
    if (!check.ok) status = ExitStatus::run_failed;
  }
  print({.table = self_check_table(checks)}, options.common);
  return status;
}

}  // namespace hwsim::cli
