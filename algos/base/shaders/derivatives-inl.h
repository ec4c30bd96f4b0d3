// Screen derivatives for shaders that also run on the counting type. Per-target include guard, see
// simd/lanes-inl.h.
#include <hwy/highway.h>
#include "pipeline/shade/count_fragment-inl.h"
#if defined(HWSIM_ALGOS_BASE_SHADERS_DERIVATIVES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_BASE_SHADERS_DERIVATIVES_INL_H_
#undef HWSIM_ALGOS_BASE_SHADERS_DERIVATIVES_INL_H_
#else
#define HWSIM_ALGOS_BASE_SHADERS_DERIVATIVES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

// Lanes have their own, the counting type charges one subtraction.
inline pipeline::CountF ddx(pipeline::CountF a) { return min(a, a); }
inline pipeline::CountF ddy(pipeline::CountF a) { return min(a, a); }

/// Slopes of a depth, as half floats hold them: at grazing angles they would overflow.
template <class F>
pipeline::HWY_NAMESPACE::Vec2<F> depth_gradient(F z) {
  const F limit(65504.0f);
  return {min(abs(ddx(z)), limit), min(abs(ddy(z)), limit)};
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
