#pragma once
// Values of flags that have a syntax of their own. Mistakes are InputErrors with ExitStatus::usage.
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments/command.h"
#include "cost_models/table_number.h"

namespace hwsim::cli {

/// "csv" or "csv=passes.csv". Throws InputError U003.
FormatRequest parse_format(const std::string& text);

/// What stands behind the name of a flag whose value is no number of the range; empty where it is one.
std::string number_complaint(const std::string& text, const cost_models::NumberRange& range,
                             const std::string& unit);

}  // namespace hwsim::cli
