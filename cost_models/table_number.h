#pragma once
// Numbers that users may write: in tables (published values, their mapping, parameters, statements, optima)
// and on the command line.
#include <optional>
#include <string>
#include <string_view>

namespace hwsim::cost_models {

/// Both ends belong to it; a range without bounds holds every finite number.
struct NumberRange {
  double low = -1e300, high = 1e300;
  bool whole = false;
};

/// The number that the whole text is, or none: `nan`, `inf`, `1x`, an empty text and what lies outside of the
/// range are none.
std::optional<double> table_number(std::string_view text, const NumberRange& range = {});

/// "a number from 0 to 100".
std::string range_text(const NumberRange& range);

}  // namespace hwsim::cost_models
