// The lane types of shaders and kernels on the host's vector registers. Included once for each target by
// foreach_target.h: per-target include guard, names in HWY_NAMESPACE.
#include <hwy/highway.h>

#include "pipeline/simd/transcendental-inl.h"
#include "pipeline/simd/vec-inl.h"

#if defined(HWSIM_SIMD_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SIMD_LANES_INL_H_
#undef HWSIM_SIMD_LANES_INL_H_
#else
#define HWSIM_SIMD_LANES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DI = hn::ScalableTag<std::int32_t>;
using DU = hn::ScalableTag<std::uint32_t>;
using VF = hn::Vec<DF>;
using VI = hn::Vec<DI>;
using VM = hn::Mask<DF>;
inline constexpr int kVectorLanes = static_cast<int>(HWY_MAX_BYTES / 4);  // 4, 8 or 16; a multiple of a quad

/// The bits of one register's lanes.
inline constexpr std::uint64_t kRegisterBits = (std::uint64_t{1} << kVectorLanes) - 1;

struct LaneM {
  VM v;
};
struct LaneI {
  VI v;
  LaneI() = default;
  HWY_INLINE LaneI(std::int32_t x) : v(hn::Set(DI(), x)) {}  // NOLINT
  HWY_INLINE explicit LaneI(VI x) : v(x) {}
};
struct LaneF {
  VF v;
  LaneF() = default;
  HWY_INLINE LaneF(float x) : v(hn::Set(DF(), x)) {}  // NOLINT
  HWY_INLINE explicit LaneF(VF x) : v(x) {}
};

HWY_INLINE LaneF operator+(LaneF a, LaneF b) { return LaneF(hn::Add(a.v, b.v)); }
HWY_INLINE LaneF operator-(LaneF a, LaneF b) { return LaneF(hn::Sub(a.v, b.v)); }
HWY_INLINE LaneF operator*(LaneF a, LaneF b) { return LaneF(hn::Mul(a.v, b.v)); }
HWY_INLINE LaneF operator/(LaneF a, LaneF b) { return LaneF(hn::Div(a.v, b.v)); }
HWY_INLINE LaneF operator-(LaneF a) { return LaneF(hn::Neg(a.v)); }
HWY_INLINE LaneF abs(LaneF a) { return LaneF(hn::Abs(a.v)); }
HWY_INLINE LaneM operator<(LaneF a, LaneF b) { return {hn::Lt(a.v, b.v)}; }
HWY_INLINE LaneM operator<=(LaneF a, LaneF b) { return {hn::Le(a.v, b.v)}; }
HWY_INLINE LaneM operator>(LaneF a, LaneF b) { return {hn::Gt(a.v, b.v)}; }
HWY_INLINE LaneM operator>=(LaneF a, LaneF b) { return {hn::Ge(a.v, b.v)}; }
// By comparison, not by hn::Min: its result for a NaN differs between targets.
HWY_INLINE LaneF min(LaneF a, LaneF b) { return LaneF(hn::IfThenElse(hn::Lt(a.v, b.v), a.v, b.v)); }
HWY_INLINE LaneF max(LaneF a, LaneF b) { return LaneF(hn::IfThenElse(hn::Gt(a.v, b.v), a.v, b.v)); }
HWY_INLINE LaneF floor(LaneF a) { return LaneF(hn::Floor(a.v)); }
HWY_INLINE LaneF sqrt(LaneF a) { return LaneF(hn::Sqrt(a.v)); }
HWY_INLINE LaneF rsqrt(LaneF a) { return LaneF(hn::Div(hn::Set(DF(), 1.0f), hn::Sqrt(a.v))); }
HWY_INLINE LaneM operator&(LaneM a, LaneM b) { return {hn::And(a.v, b.v)}; }
HWY_INLINE LaneM operator|(LaneM a, LaneM b) { return {hn::Or(a.v, b.v)}; }
HWY_INLINE LaneM operator!(LaneM a) { return {hn::Not(a.v)}; }
HWY_INLINE LaneF select(LaneM m, LaneF a, LaneF b) { return LaneF(hn::IfThenElse(m.v, a.v, b.v)); }
HWY_INLINE LaneI select(LaneM m, LaneI a, LaneI b) {
  return LaneI(hn::IfThenElse(hn::RebindMask(DI(), m.v), a.v, b.v));
}
HWY_INLINE LaneI operator+(LaneI a, LaneI b) { return LaneI(hn::Add(a.v, b.v)); }
HWY_INLINE LaneI operator-(LaneI a, LaneI b) { return LaneI(hn::Sub(a.v, b.v)); }
HWY_INLINE LaneI operator*(LaneI a, LaneI b) { return LaneI(hn::Mul(a.v, b.v)); }
HWY_INLINE LaneI operator&(LaneI a, LaneI b) { return LaneI(hn::And(a.v, b.v)); }
HWY_INLINE LaneI operator|(LaneI a, LaneI b) { return LaneI(hn::Or(a.v, b.v)); }
HWY_INLINE LaneI operator^(LaneI a, LaneI b) { return LaneI(hn::Xor(a.v, b.v)); }
template <int kBits>
HWY_INLINE LaneI shift_left(LaneI a) {
  return LaneI(hn::ShiftLeft<kBits>(a.v));
}
template <int kBits>
HWY_INLINE LaneI shift_right(LaneI a) {
  return LaneI(hn::ShiftRight<kBits>(a.v));
}
HWY_INLINE LaneI min(LaneI a, LaneI b) { return LaneI(hn::Min(a.v, b.v)); }
HWY_INLINE LaneI max(LaneI a, LaneI b) { return LaneI(hn::Max(a.v, b.v)); }
HWY_INLINE LaneM operator<(LaneI a, LaneI b) { return {hn::RebindMask(DF(), hn::Lt(a.v, b.v))}; }
HWY_INLINE LaneM operator>(LaneI a, LaneI b) { return {hn::RebindMask(DF(), hn::Gt(a.v, b.v))}; }
HWY_INLINE LaneM operator==(LaneI a, LaneI b) { return {hn::RebindMask(DF(), hn::Eq(a.v, b.v))}; }
HWY_INLINE LaneM operator!=(LaneI a, LaneI b) { return !(a == b); }
HWY_INLINE LaneI to_int(LaneF a) { return LaneI(hn::ConvertTo(DI(), a.v)); }
/// To the nearest integer, ties to even, for |a| < 2^31 (hn::NearestInt also mends overflow, at three more
/// operations).
HWY_INLINE LaneI round_to_int(LaneF a) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
  return LaneI(VI{_mm512_cvtps_epi32(a.v.raw)});
#else
  return LaneI(hn::NearestInt(a.v));
#endif
}
HWY_INLINE LaneF to_float(LaneI a) { return LaneF(hn::ConvertTo(DF(), a.v)); }
HWY_INLINE LaneF bits_to_float(LaneI a) { return LaneF(hn::BitCast(DF(), a.v)); }
HWY_INLINE LaneI float_to_bits(LaneF a) { return LaneI(hn::BitCast(DI(), a.v)); }
HWY_INLINE LaneF exp2(LaneF a) { return exp2_polynomial<LaneF, LaneI>(a); }
HWY_INLINE LaneF log2(LaneF a) { return log2_polynomial<LaneF, LaneI>(a); }
HWY_INLINE std::int32_t first_value(LaneI a) { return hn::GetLane(a.v); }
HWY_INLINE bool any(LaneM m) { return !hn::AllFalse(DF(), m.v); }

HWY_INLINE LaneF load(const float* p) { return LaneF(hn::LoadU(DF(), p)); }
HWY_INLINE LaneI load(const std::int32_t* p) { return LaneI(hn::LoadU(DI(), p)); }
HWY_INLINE void store(LaneF a, float* p) { hn::StoreU(a.v, DF(), p); }
HWY_INLINE void store(LaneI a, std::int32_t* p) { hn::StoreU(a.v, DI(), p); }
HWY_INLINE LaneF gather(const float* base, LaneI index) {
  return LaneF(hn::GatherIndex(DF(), base, index.v));
}
HWY_INLINE LaneI gather(const std::int32_t* base, LaneI index) {
  return LaneI(hn::GatherIndex(DI(), base, index.v));
}

HWY_INLINE LaneF lookup(const float* table, LaneI index) { return gather(table, index); }

// Between masks and bits. AVX-512 masks are bits: going through memory, as the portable functions do, stalls
// on store forwarding (it was a tenth of the raster time).
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
/// Bit i of the result is lane i.
HWY_INLINE std::uint32_t mask_bits(LaneM m) { return m.v.raw; }
/// Lane i of the mask is bit (first_lane + i) of `bits`.
HWY_INLINE LaneM mask_from_bits(std::uint64_t bits, int first_lane) {
  return {VM{static_cast<decltype(VM::raw)>(bits >> first_lane)}};
}
#else
HWY_INLINE std::uint32_t mask_bits(LaneM m) {
  std::uint8_t bytes[8];
  hn::StoreMaskBits(DF(), m.v, bytes);
  static_assert(kVectorLanes <= 8);  // one byte holds them
  return bytes[0] & ((1u << kVectorLanes) - 1);
}
HWY_INLINE LaneM mask_from_bits(std::uint64_t bits, int first_lane) {
  const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits >> first_lane & ((1u << kVectorLanes) - 1))};
  return {hn::LoadMaskBits(DF(), bytes)};
}
#endif

/// body(lane, value) for the lanes of `bits`, in order.
template <class Body>
HWY_INLINE void for_each_lane(LaneI a, std::uint32_t bits, Body&& body) {
  HWY_ALIGN std::int32_t values[kVectorLanes];
  store(a, values);
  for (; bits != 0; bits &= bits - 1) {
    const int lane = __builtin_ctz(bits);
    body(lane, values[lane]);
  }
}

// Coarse derivatives: one value for a quad, from its top left lane's neighbors.
HWY_INLINE LaneF ddx(LaneF a) { return LaneF(hn::Sub(hn::Broadcast<1>(a.v), hn::Broadcast<0>(a.v))); }
HWY_INLINE LaneF ddy(LaneF a) { return LaneF(hn::Sub(hn::Broadcast<2>(a.v), hn::Broadcast<0>(a.v))); }

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
