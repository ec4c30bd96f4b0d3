// What edge filters share: luma, masks, colors by mask. Per-target include guard.
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

#if defined(HWSIM_ALGOS_FILTERS_SHADERS_EDGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_FILTERS_SHADERS_EDGES_INL_H_
#undef HWSIM_ALGOS_FILTERS_SHADERS_EDGES_INL_H_
#else
#define HWSIM_ALGOS_FILTERS_SHADERS_EDGES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {
namespace lanes = pipeline::HWY_NAMESPACE;

/// Rec. 601 weights (FXAA, MLAA) and Rec. 709 weights (SMAA, CMAA), of perceptual color.
template <class F>
F luma_601(const lanes::Vec4<F>& c) {
  return F(0.299f) * c.x + F(0.587f) * c.y + F(0.114f) * c.z;
}
template <class F>
F luma_709(const lanes::Vec4<F>& c) {
  return F(0.2126f) * c.x + F(0.7152f) * c.y + F(0.0722f) * c.z;
}

template <class M, class F>
lanes::Vec4<F> select_color(M mask, const lanes::Vec4<F>& a, const lanes::Vec4<F>& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z), select(mask, a.w, b.w)};
}

/// Exactly one of two conditions.
template <class M>
M differ(M a, M b) {
  return (a & !b) | (b & !a);
}

/// A coordinate of the pixel's center.
template <class F, class I>
F center_of(I pixel) {
  return to_float(pixel) + F(0.5f);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
