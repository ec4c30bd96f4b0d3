// Bit counts, shifts by lane, and functions of angles, on every lane type. Per-target include guard, see
// simd/lanes-inl.h.
#include "pipeline/shade/count_lane.h"
#include "pipeline/simd/lanes-inl.h"
#include "pipeline/simd/scalar_lane-inl.h"

#if defined(HWSIM_SHADE_BIT_OPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SHADE_BIT_OPS_INL_H_
#undef HWSIM_SHADE_BIT_OPS_INL_H_
#else
#define HWSIM_SHADE_BIT_OPS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

HWY_INLINE LaneI bit_count(LaneI a) {
  return LaneI(hn::BitCast(DI(), hn::PopulationCount(hn::BitCast(DU(), a.v))));
}
inline ScalarI bit_count(ScalarI a) { return __builtin_popcount(static_cast<unsigned>(a.v)); }
inline CountI bit_count(CountI a) { return CountI(count_detail::alu(a)); }

/// Number of the lowest set bit; 32 for 0.
HWY_INLINE LaneI lowest_bit(LaneI a) {
  return bit_count(LaneI(hn::AndNot(a.v, hn::Sub(a.v, hn::Set(DI(), 1)))));
}
inline ScalarI lowest_bit(ScalarI a) { return a.v == 0 ? 32 : __builtin_ctz(static_cast<unsigned>(a.v)); }
inline CountI lowest_bit(CountI a) { return CountI(count_detail::alu(a)); }

/// a shifted right by 0 to 31 bits, the sign copied.
HWY_INLINE LaneI shift_right_by(LaneI a, LaneI bits) { return LaneI(hn::Shr(a.v, bits.v)); }
inline ScalarI shift_right_by(ScalarI a, ScalarI bits) { return a.v >> bits.v; }
inline CountI shift_right_by(CountI a, CountI bits) { return CountI(count_detail::alu(a, bits)); }

/// sin(2 pi t). Absolute error < 3e-7 for |t| < 1000.
template <class F>
F sine_turns_polynomial(F t) {
  t = t - floor(t + F(0.5f));  // [-0.5, 0.5]
  t = select(t > F(0.25f), F(0.5f) - t, select(t < F(-0.25f), F(-0.5f) - t, t));
  const F x = t * F(6.283185307f);
  const F x2 = x * x;
  F p = F(-2.505210839e-8f);  // Taylor, |x| <= pi/2: the next term is below 6e-8
  p = p * x2 + F(2.755731922e-6f);
  p = p * x2 + F(-1.984126984e-4f);
  p = p * x2 + F(8.333333333e-3f);
  p = p * x2 + F(-1.666666667e-1f);
  return x + x * x2 * p;
}
HWY_INLINE LaneF sine_turns(LaneF t) { return sine_turns_polynomial<LaneF>(t); }
inline ScalarF sine_turns(ScalarF t) { return sine_turns_polynomial<ScalarF>(t); }
inline CountF sine_turns(CountF t) { return count_detail::sfu(t); }
template <class F>
F cosine_turns(F t) {
  return sine_turns(t + F(0.25f));
}

/// arccos on [0, 1]. Absolute error < 4e-7 (Abramowitz and Stegun 4.4.46).
template <class F>
F arccosine(F x) {
  F p = F(-0.0012624911f);
  p = p * x + F(0.0066700901f);
  p = p * x + F(-0.0170881256f);
  p = p * x + F(0.0308918810f);
  p = p * x + F(-0.0501743046f);
  p = p * x + F(0.0889789874f);
  p = p * x + F(-0.2145988016f);
  p = p * x + F(1.5707963050f);
  return sqrt(max(F(1.0f) - x, F(0.0f))) * p;
}

/// Angle of (x, y) in turns, [0, 1); 0 for the zero vector. Absolute error < 1e-7 (Abramowitz and Stegun
/// 4.4.49).
template <class F>
F angle_turns(F y, F x) {
  const F ax = abs(x), ay = abs(y);
  const F a = min(ax, ay) / max(max(ax, ay), F(1e-30f));
  const F a2 = a * a;
  F p = F(0.0028662257f);
  p = p * a2 + F(-0.0161657367f);
  p = p * a2 + F(0.0429096138f);
  p = p * a2 + F(-0.0752896400f);
  p = p * a2 + F(0.1065626393f);
  p = p * a2 + F(-0.1420889944f);
  p = p * a2 + F(0.1999355085f);
  p = p * a2 + F(-0.3333314528f);
  F t = (a + a * a2 * p) * F(0.1591549431f);
  t = select(ay > ax, F(0.25f) - t, t);
  t = select(x < F(0.0f), F(0.5f) - t, t);
  t = select(y < F(0.0f), F(1.0f) - t, t);
  return select(t >= F(1.0f), F(0.0f), t);
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
