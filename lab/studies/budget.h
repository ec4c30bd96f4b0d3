#pragma once
// `--budget "aa_ms<=1.5, extra_mib<=192"` and what it says of a technique.
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hwsim::lab {

/// What a budget can limit; `aa_` and `extra_` are relative to no anti-aliasing at all.
struct Costs {
  double frame_ms = 0.0, aa_ms = 0.0, memory_mib = 0.0, extra_mib = 0.0, dram_mb = 0.0;
  std::optional<std::array<double, 2>> interval_ms;     ///< 90 %, of frame_ms
  std::optional<std::array<double, 2>> aa_interval_ms;  ///< the same of aa_ms
};

struct Limit {
  std::string quantity;  ///< a member of Costs
  double at_most = 0.0;
};

/// Throws InputError U022.
std::vector<Limit> parse_budget(const std::string& text);

/// ok, unknown (a time without an interval is within the limit), at risk (within the limit, the upper end of
/// the interval beyond it), over time, over memory. Memory is counted, not predicted: it has no interval.
std::string_view verdict(const Costs& costs, const std::vector<Limit>& budget);

}  // namespace hwsim::lab
