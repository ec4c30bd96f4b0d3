#pragma once
// Ranges that keys of several units share. They are wide on purpose: any positive value must work in a
// what-if; only the sign, the order of magnitude and ratios above one are refused.
namespace hwsim {

inline constexpr double kRateLow = 1e-3;  // items per clock
inline constexpr double kRateHigh = 1e6;
/// A unit that is never fed is not a ratio of zero: leave the work out.
inline constexpr double kRatioLow = 1e-3;
inline constexpr double kKibHigh = 4.0 * 1024 * 1024;

/// std::min and std::max return references to arguments and do not know Jets' comparisons in constant
/// expressions; these return values.
template <class T>
T smaller(const T& a, const T& b) {
  return b < a ? b : a;
}
template <class T>
T larger(const T& a, const T& b) {
  return a < b ? b : a;
}

}  // namespace hwsim
