#pragma once
// The command line as a command with its options.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments/command.h"

namespace hwsim::cli {

/// Throws InputError with ExitStatus::usage and codes U0xx.
Command parse_arguments(int argc, const char* const* argv);

/// The help text of a command ("run", "config check"); nothing for an unknown one.
std::optional<std::string> help_text(std::string_view command);

/// What shells complete.
struct FlagInfo {
  std::vector<std::string> names;  ///< "-q", "--quiet"
  std::string description;
  bool takes_value = false;
};
struct CommandInfo {
  std::string name;  ///< "config check"
  std::string description;
  std::vector<FlagInfo> flags;
};
std::vector<CommandInfo> describe_commands();

}  // namespace hwsim::cli
