#pragma once
// Short ways to raise an error.
#include <span>
#include <string>
#include <string_view>

#include "hwsim/base/diagnostics.h"

namespace hwsim::lab {

/// An error without a place in a file.
Diagnostic problem(std::string code, std::string message, std::string hint = {}, std::string help = {});

[[noreturn]] void fail(std::string code, std::string message, std::string hint = {}, std::string help = {});

/// A mistake in the command line itself: exit status 2.
[[noreturn]] void fail_usage(std::string code, std::string message, std::string hint = {},
                             std::string help = "`hwsim --help` lists the commands and their flags");

}  // namespace hwsim::lab
