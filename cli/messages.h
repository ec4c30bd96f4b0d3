#pragma once
#include <span>
#include <string>
#include <string_view>

#include "hwsim/base/diagnostics.h"

namespace hwsim::cli {

/// An error without a place in a file.
Diagnostic problem(std::string code, std::string message, std::string hint = {}, std::string help = {});

/// "did you mean `msaa4x`?", or nothing when no candidate is near.
std::string did_you_mean(std::string_view name, std::span<const std::string> candidates);

[[noreturn]] void fail(std::string code, std::string message, std::string hint = {}, std::string help = {});

/// A mistake in the command line itself: exit status 2.
[[noreturn]] void fail_usage(std::string code, std::string message, std::string hint = {},
                             std::string help = "`hwsim --help` lists the commands and their flags");

}  // namespace hwsim::cli
