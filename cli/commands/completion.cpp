#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/completion_scripts.h"
#include "lab/base/messages.h"

namespace hwsim::cli {

ExitStatus completion(const CompletionArguments& options, Context&) {
  const std::string script = completion_script(options.shell, describe_commands());
  if (script.empty())
    fail_usage("U003", "no completion for `" + options.shell + "`, only for bash, zsh and fish");
  write_output(script);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
