// What the passes of CMAA share: edges of a pixel, and where they are stored. Per-target include guard.
#include <array>

#include "algos/filters/shaders/edges-inl.h"

#if defined(HWSIM_ALGOS_FILTERS_SHADERS_CMAA_EDGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_FILTERS_SHADERS_CMAA_EDGES_INL_H_
#undef HWSIM_ALGOS_FILTERS_SHADERS_CMAA_EDGES_INL_H_
#else
#define HWSIM_ALGOS_FILTERS_SHADERS_CMAA_EDGES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

/// Edges of a pixel. The first two are found between passes, all four in the combined mask.
enum CmaaEdge : int { kRightEdge = 1, kBottomEdge = 2, kLeftEdge = 4, kTopEdge = 8 };
/// Marks what this frame stored among what combining left of the frame before.
inline constexpr int kFreshEdges = 128;

template <class S>
typename S::M bit_set(typename S::I bits, int mask) {
  return (bits & typename S::I(mask)) > typename S::I(0);
}
/// The bits of `set` are there, and no other of `mask`.
template <class S>
typename S::M bits_are(typename S::I bits, int mask, int set) {
  return (bits & typename S::I(mask)) == typename S::I(set);
}

/// The texels from (x + dx, y + dy) on, two by two, of an image of small whole numbers.
template <class S>
std::array<typename S::I, 4> four_texels(S& s, typename S::I x, typename S::I y, int dx, int dy) {
  const auto t = s.gather_image(0, 0, x, y, dx, dy);
  return {to_int(t.t00), to_int(t.t10), to_int(t.t01), to_int(t.t11)};
}

/// To pixel p of the invocation's four.
template <class S>
void store_quad_pixel(S& s, int p, typename S::F value, typename S::M mask) {
  using F = typename S::F;
  using I = typename S::I;
  const I x = s.pixel_x() + s.pixel_x() + I(p & 1), y = s.pixel_y() + s.pixel_y() + I(p >> 1);
  s.store_image(0, x, y, I(0), {value, F(0.0f), F(0.0f), F(0.0f)},
                mask & (x < I(s.target_width(0))) & (y < I(s.target_height(0))));
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
