// The 2x2 texels of a gather or a bilinear filter, and what a comparison sampler makes of them, for every
// lane type. Per-target include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>

#if defined(HWSIM_SHADE_TEXEL_QUAD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SHADE_TEXEL_QUAD_INL_H_
#undef HWSIM_SHADE_TEXEL_QUAD_INL_H_
#else
#define HWSIM_SHADE_TEXEL_QUAD_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// One channel of texels (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1).
template <class F>
struct TexelQuad {
  F t00, t10, t01, t11;
};

/// A comparison sampler with a bilinear filter: each texel answers `reference` <= texel, the answers are
/// weighed. Coordinates in texels, centers at one half; quad(x, y): the texels from (x, y) on.
template <class F, class I, class Quad>
HWY_INLINE F compare_bilinear(F x, F y, F reference, Quad&& quad) {
  const F from_x = x - F(0.5f), from_y = y - F(0.5f);
  const F left = floor(from_x), top = floor(from_y);
  const F fx = from_x - left, fy = from_y - top;
  // Far outside the image the conversion would overflow.
  const TexelQuad<F> texels =
      quad(to_int(min(max(left, F(-1.0e6f)), F(1.0e6f))), to_int(min(max(top, F(-1.0e6f)), F(1.0e6f))));
  const auto passes = [&](F texel) HWY_ATTR { return select(reference <= texel, F(1.0f), F(0.0f)); };
  const F upper = passes(texels.t00) * (F(1.0f) - fx) + passes(texels.t10) * fx;
  const F lower = passes(texels.t01) * (F(1.0f) - fx) + passes(texels.t11) * fx;
  return upper + (lower - upper) * fy;
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
