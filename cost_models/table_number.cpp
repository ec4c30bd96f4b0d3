#include "cost_models/table_number.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace hwsim::cost_models {

std::optional<double> table_number(std::string_view text, const NumberRange& range) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  if (value < range.low || value > range.high) return std::nullopt;
  if (range.whole && value != std::floor(value)) return std::nullopt;
  return value;
}

std::string range_text(const NumberRange& range) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "a %snumber from %g to %g", range.whole ? "whole " : "", range.low,
                range.high);
  return text.data();
}

}  // namespace hwsim::cost_models
