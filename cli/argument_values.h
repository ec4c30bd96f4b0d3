#pragma once
// Values of flags that have a syntax of their own. Mistakes are InputErrors with ExitStatus::usage.
#include <string>
#include <string_view>
#include <vector>

#include "cli/options.h"

namespace hwsim::cli {

std::vector<std::string> split(std::string_view text, char separator);

/// "csv" or "csv=passes.csv". Throws InputError U003.
FormatRequest parse_format(const std::string& text);

/// "1280x720". Throws InputError U005.
Resolution parse_resolution(std::string_view text);

/// Splits "msaa4x,agaa:c=2,msaa=8" into techniques: a piece whose '=' comes before any ':' is a parameter
/// of the one before it.
std::vector<std::string> split_techniques(std::string_view text);

}  // namespace hwsim::cli
