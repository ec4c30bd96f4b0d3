#pragma once
// Factors between units of measure: the only place where a number says how many of one make another.
namespace hwsim {

inline constexpr double kNsPerUs = 1e3;
inline constexpr double kNsPerMs = 1e6;
inline constexpr double kBytesPerKib = 1024.0;
inline constexpr double kBytesPerMib = 1024.0 * 1024.0;
inline constexpr double kBytesPerMb = 1e6;

}  // namespace hwsim
