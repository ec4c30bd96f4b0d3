// The functions exp2 and log2, made of exact operations (add, multiply, floor, shifts), so that every vector
// width and the scalar type give the same bits. The library's functions differ between targets. Per-target
// include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>

#if defined(HWSIM_SIMD_TRANSCENDENTAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SIMD_TRANSCENDENTAL_INL_H_
#undef HWSIM_SIMD_TRANSCENDENTAL_INL_H_
#else
#define HWSIM_SIMD_TRANSCENDENTAL_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// 2^x. Relative error < 2.4e-7 for x in [-126, 127]; clamped outside: 2^-126 and 2^127. (Swept by a test.)
template <class F, class I>
F exp2_polynomial(F x) {
  x = min(max(x, F(-126.0f)), F(127.0f));
  const F whole = floor(x + F(0.5f));
  const F f = x - whole;  // [-0.5, 0.5]
  F p = F(1.535336188319500e-4f);
  p = p * f + F(1.339887440266574e-3f);
  p = p * f + F(9.618437357674640e-3f);
  p = p * f + F(5.550332471162809e-2f);
  p = p * f + F(2.402264791363012e-1f);
  p = p * f + F(6.931472028550421e-1f);
  p = p * f + F(1.0f);
  return p * bits_to_float(shift_left<23>(to_int(whole) + I(127)));
}

/// log2(x) for normal x > 0; smaller values count as 2^-126. Absolute error < 4e-7 for x in [0.5, 2],
/// relative < 2e-7 elsewhere. The mantissa is taken to [sqrt(1/2), sqrt(2)) and its logarithm is
/// 2/ln2 * (t + t^3/3 + t^5/5 + ...) with t = (m - 1) / (m + 1), |t| < 0.1716.
template <class F, class I>
F log2_polynomial(F x) {
  x = max(x, F(1.17549435e-38f));
  const I bits = float_to_bits(x);
  const I exponent = shift_right<23>(bits - I(0x3f3504f3));  // 0x3f3504f3 is sqrt(1/2); a signed shift floors
  const F m = bits_to_float(bits - shift_left<23>(exponent));
  const F t = (m - F(1.0f)) / (m + F(1.0f));
  const F t2 = t * t;
  F p = F(0.3205989f);         // 2/(9 ln2)
  p = p * t2 + F(0.4121986f);  // 2/(7 ln2)
  p = p * t2 + F(0.5770780f);  // 2/(5 ln2)
  p = p * t2 + F(0.9617967f);  // 2/(3 ln2)
  p = p * t2 + F(2.8853901f);  // 2/ln2
  return to_float(exponent) + p * t;
}

/// x^y for x >= 0 (0 counts as 2^-126).
template <class F>
F pow(F x, F y) {
  return exp2(log2(x) * y);
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
