#pragma once
// Completion scripts: commands and flags are written into them; names of GPUs, scenes and techniques are
// asked for when the user presses the key, so that they are those of the installed files.
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments/arguments.h"

namespace hwsim::cli {

/// The script of a shell: bash, zsh or fish; empty for others.
std::string completion_script(std::string_view shell, const std::vector<CommandInfo>& commands);

}  // namespace hwsim::cli
