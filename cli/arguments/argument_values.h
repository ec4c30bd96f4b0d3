#pragma once
// Values of flags that have a syntax of their own. Mistakes are InputErrors with ExitStatus::usage.
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments/command.h"

namespace hwsim::cli {

/// "csv" or "csv=passes.csv". Throws InputError U003.
FormatRequest parse_format(const std::string& text);

}  // namespace hwsim::cli
