// One lane: the same shader source evaluated a value at a time, for the ray-traced reference and for tests.
// Per-target include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>
#include <bit>
#include <cmath>
#include <cstdint>
#include "pipeline/simd/transcendental-inl.h"
#if defined(HWSIM_SIMD_SCALAR_LANE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SIMD_SCALAR_LANE_INL_H_
#undef HWSIM_SIMD_SCALAR_LANE_INL_H_
#else
#define HWSIM_SIMD_SCALAR_LANE_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

struct ScalarM {
  bool v;
};
struct ScalarI {
  std::int32_t v;
  ScalarI() = default;
  ScalarI(std::int32_t x) : v(x) {}  // NOLINT
};
struct ScalarF {
  float v;
  ScalarF() = default;
  ScalarF(float x) : v(x) {}  // NOLINT
};

inline ScalarF operator+(ScalarF a, ScalarF b) { return a.v + b.v; }
inline ScalarF operator-(ScalarF a, ScalarF b) { return a.v - b.v; }
inline ScalarF operator*(ScalarF a, ScalarF b) { return a.v * b.v; }
inline ScalarF operator/(ScalarF a, ScalarF b) { return a.v / b.v; }
inline ScalarF operator-(ScalarF a) { return -a.v; }
inline ScalarF abs(ScalarF a) { return std::fabs(a.v); }
inline ScalarF min(ScalarF a, ScalarF b) { return a.v < b.v ? a.v : b.v; }  // as minps: b when either is NaN
inline ScalarF max(ScalarF a, ScalarF b) { return a.v > b.v ? a.v : b.v; }
inline ScalarF floor(ScalarF a) { return std::floor(a.v); }
inline ScalarF sqrt(ScalarF a) { return std::sqrt(a.v); }
inline ScalarF rsqrt(ScalarF a) { return 1.0f / std::sqrt(a.v); }
inline ScalarM operator<(ScalarF a, ScalarF b) { return {a.v < b.v}; }
inline ScalarM operator<=(ScalarF a, ScalarF b) { return {a.v <= b.v}; }
inline ScalarM operator>(ScalarF a, ScalarF b) { return {a.v > b.v}; }
inline ScalarM operator>=(ScalarF a, ScalarF b) { return {a.v >= b.v}; }
inline ScalarM operator&(ScalarM a, ScalarM b) { return {a.v && b.v}; }
inline ScalarM operator|(ScalarM a, ScalarM b) { return {a.v || b.v}; }
inline ScalarM operator!(ScalarM a) { return {!a.v}; }
inline ScalarF select(ScalarM m, ScalarF a, ScalarF b) { return m.v ? a : b; }
inline ScalarI select(ScalarM m, ScalarI a, ScalarI b) { return m.v ? a : b; }
inline ScalarI operator+(ScalarI a, ScalarI b) { return a.v + b.v; }
inline ScalarI operator-(ScalarI a, ScalarI b) { return a.v - b.v; }
inline ScalarI operator*(ScalarI a, ScalarI b) {  // wraps, as the lanes do
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a.v) * static_cast<std::uint32_t>(b.v));
}
inline ScalarI operator&(ScalarI a, ScalarI b) { return a.v & b.v; }
inline ScalarI operator|(ScalarI a, ScalarI b) { return a.v | b.v; }
inline ScalarI operator^(ScalarI a, ScalarI b) { return a.v ^ b.v; }
template <int kBits>
ScalarI shift_left(ScalarI a) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a.v) << kBits);
}
template <int kBits>
ScalarI shift_right(ScalarI a) {
  return a.v >> kBits;
}
inline ScalarI min(ScalarI a, ScalarI b) { return a.v < b.v ? a.v : b.v; }
inline ScalarI max(ScalarI a, ScalarI b) { return a.v > b.v ? a.v : b.v; }
inline ScalarM operator<(ScalarI a, ScalarI b) { return {a.v < b.v}; }
inline ScalarM operator>(ScalarI a, ScalarI b) { return {a.v > b.v}; }
inline ScalarM operator==(ScalarI a, ScalarI b) { return {a.v == b.v}; }
inline ScalarM operator!=(ScalarI a, ScalarI b) { return {a.v != b.v}; }
/// Saturates by the sign, NaN too, as the lanes' conversion does; the language leaves it undefined.
inline ScalarI to_int(ScalarF a) {
  if (std::fabs(a.v) < 0x1p31f) return static_cast<std::int32_t>(a.v);
  return std::signbit(a.v) ? INT32_MIN : INT32_MAX;
}
inline ScalarF to_float(ScalarI a) { return static_cast<float>(a.v); }
inline ScalarF bits_to_float(ScalarI a) { return std::bit_cast<float>(a.v); }
inline ScalarI float_to_bits(ScalarF a) { return std::bit_cast<std::int32_t>(a.v); }
inline ScalarF exp2(ScalarF a) { return exp2_polynomial<ScalarF, ScalarI>(a); }
inline ScalarF log2(ScalarF a) { return log2_polynomial<ScalarF, ScalarI>(a); }
inline ScalarF lookup(const float* table, ScalarI index) { return table[index.v]; }
inline std::int32_t first_value(ScalarI a) { return a.v; }
inline bool any(ScalarM m) { return m.v; }
inline ScalarF gather(const float* base, ScalarI index) { return base[index.v]; }
inline ScalarI gather(const std::int32_t* base, ScalarI index) { return base[index.v]; }
inline std::uint32_t mask_bits(ScalarM m) { return m.v ? 1u : 0u; }
template <class Body>
void for_each_lane(ScalarI a, std::uint32_t bits, Body&& body) {
  if (bits != 0) body(0, a.v);
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
