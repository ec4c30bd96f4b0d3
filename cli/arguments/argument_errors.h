#pragma once
// What the parsed application knows of its commands and flags, and what is said of a line that does not
// parse.
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/arguments/arguments.h"

namespace hwsim::cli {

/// The subcommand that the words before the first flag lead to, for messages and for `help`.
const CLI::App& selected(const CLI::App& app, const std::vector<std::string>& words);

std::vector<std::string> subcommand_names(const CLI::App& app);

/// Flags with those of the option groups.
std::vector<FlagInfo> flags_of(const CLI::App& app);

/// A command that is not there, before CLI11 reports it as some missing flag.
void check_command_names(const CLI::App& app, const std::vector<std::string>& words);

/// CLI11's error as a message of ours: U001 to U004, exit status 2.
[[noreturn]] void fail_parse(const CLI::ParseError& error, const CLI::App& app,
                             const std::vector<std::string>& words);

}  // namespace hwsim::cli
