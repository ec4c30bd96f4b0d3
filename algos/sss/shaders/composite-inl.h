// What was sampled, over the frame. Per-target include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>
#include "algos/sss/shaders/view-inl.h"
#if defined(HWSIM_ALGOS_SSS_SHADERS_COMPOSITE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_SSS_SHADERS_COMPOSITE_INL_H_
#undef HWSIM_ALGOS_SSS_SHADERS_COMPOSITE_INL_H_
#else
#define HWSIM_ALGOS_SSS_SHADERS_COMPOSITE_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

enum SssCompositeBlock : int { kSampledBlock = 5, kOtherSamplesBlock = 6 };

/// What the frame shows beside the samples.
template <class F>
struct SssRest {
  Vec4<F> color;
  F trust;  ///< factor of the samples' part: 2 where the frame has nothing beside them
};

/// The resolved frame; with marks, in pixels that were sampled, the mean of those of its samples whose
/// triangle was not.
template <class S>
SssRest<typename S::F> rest_of_frame(S& s, const SssUniforms& u, typename S::M sampled) {
  using F = typename S::F;
  using I = typename S::I;
  const F zero(0.0f), one(1.0f);
  SssRest<F> rest = {s.load_image(kSssFrameSlot, s.pixel_x(), s.pixel_y(), I(0)), one};
  s.uniform_branch(kSampledBlock, u.mark_slot >= 0, [&]() HWY_ATTR {
    s.branch(kOtherSamplesBlock, sampled, [&]() HWY_ATTR {
      Vec4<F> all = {zero, zero, zero, zero}, others = all;
      F count = zero;
      for (int k = 0; k < kSssBaseSamples; ++k) {
        const Vec4<F> c = s.load_image(u.mark_slot + 1, s.pixel_x(), s.pixel_y(), I(k));
        const F other = one - s.load_image(u.mark_slot, s.pixel_x(), s.pixel_y(), I(k)).x;
        all = all + c;
        others = others + c * other;
        count = count + other;
      }
      const auto any_other = count > F(0.5f);
      const Vec4<F> mean = others * select(any_other, one / max(count, one), zero) +
                           all * select(any_other, zero, F(1.0f / kSssBaseSamples));
      rest.color = {select(sampled, mean.x, rest.color.x), select(sampled, mean.y, rest.color.y),
                    select(sampled, mean.z, rest.color.z), select(sampled, mean.w, rest.color.w)};
      rest.trust = select(sampled, select(any_other, one, F(2.0f)), one);
    });
  });
  return rest;
}

/// `sum`: of colors by weight, and of weights W. Their mean has the share min(1, W), and the frame the rest.
template <class S>
void blend_over_frame(S& s, const SssUniforms& u, const Vec4<typename S::F>& sum) {
  using F = typename S::F;
  const SssRest<F> frame = rest_of_frame(s, u, s.valid() & (sum.w > F(0.0f)));
  const F share = min(F(1.0f), sum.w * frame.trust), rest = F(1.0f) - share;
  const F scale = share / max(sum.w, F(1e-4f));
  s.output(0, {rest * frame.color.x + scale * sum.x, rest * frame.color.y + scale * sum.y,
               rest * frame.color.z + scale * sum.z, frame.color.w});
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
