// Texture filtering on any lane type: the emulator's registers and the scalar of the ray-traced reference.
// Per-target include guard, see shade/lanes-inl.h.
#include <hwy/highway.h>
#include <bit>
#include <cstdint>
#include "pipeline/emulate/access_tracker.h"
#include "pipeline/shade/texture_view.h"
#include "pipeline/shade/transcendental-inl.h"
#include "pipeline/shade/vec-inl.h"
#if defined(HWSIM_PIPELINE_SHADE_TEXTURE_SAMPLER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_PIPELINE_SHADE_TEXTURE_SAMPLER_INL_H_
#undef HWSIM_PIPELINE_SHADE_TEXTURE_SAMPLER_INL_H_
#else
#define HWSIM_PIPELINE_SHADE_TEXTURE_SAMPLER_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// block_hash of hwsim/reuse.h, in every lane.
template <class I>
HWY_INLINE I line_hash(I line) {
  I h = line * I(static_cast<std::int32_t>(0x9e3779b1u));
  h = h ^ (shift_right<15>(h) & I(0x1ffff));
  return h * I(static_cast<std::int32_t>(0x85ebca77u));
}

/// Notes the lanes whose line belongs to the sample: most registers hold none.
template <class I>
HWY_INLINE void track_lines(AccessTracker& tracker, I line, std::uint32_t lanes, int first_lane,
                            std::uint32_t bytes) {
  const int shift = tracker.kinds[at(ReuseStream::texture)].shift;
  const I high(static_cast<std::int32_t>(~(0xffffffffu >> shift)));
  const std::uint32_t sampled = mask_bits((line_hash(line) & high) == I(0)) & lanes;
  if (sampled == 0) return;
  for_each_lane(line, sampled, [&](int lane, std::int32_t number) HWY_ATTR {
    tracker.use((first_lane + lane) / 4, ReuseStream::texture, static_cast<std::uint32_t>(number), bytes, 0);
  });
}
/// Texture coordinates and their change for one pixel to the right and down.
template <class F>
struct TextureSite {
  F u, v, du_dx, dv_dx, du_dy, dv_dy;
};

/// Samples one texture for the lanes of `valid` (helpers included: they fetch too). A lane fetches what it
/// needs itself, not what its neighbors in a register need: otherwise counts would depend on the register's
/// width.
template <class F, class I, class M>
class TextureSampler {
 public:
  /// `first_lane`: of the register within its batch.
  TextureSampler(const TextureView& texture, AccessTracker* tracker, M valid, int first_lane = 0)
      : texture_(texture), tracker_(tracker), valid_(valid), first_lane_(first_lane) {}

  /// u, v with their derivatives for one pixel to the right and down. Adds probes beyond one a lane to
  /// `extra_probes`.
  Vec4<F> sample(F u, F v, F du_dx, F dv_dx, F du_dy, F dv_dy, std::uint64_t& extra_probes) const {
    const F w(static_cast<float>(texture_.width[0])), h(static_cast<float>(texture_.height[0]));
    const F x2 = du_dx * w * (du_dx * w) + dv_dx * h * (dv_dx * h);
    const F y2 = du_dy * w * (du_dy * w) + dv_dy * h * (dv_dy * h);
    const F major2 = max(x2, y2), minor2 = max(min(x2, y2), F(1e-12f));
    const int limit = texture_.sampler.max_anisotropy;
    if (limit <= 1) return filter(u, v, F(0.5f) * log2(major2), extra_probes);
    const F ratio = min(sqrt(max(major2, F(1e-12f)) / minor2), F(static_cast<float>(limit)));
    const F probes = max(floor(ratio + F(0.999f)), F(1.0f));
    const F lod = F(0.5f) * log2(major2) - log2(probes);
    const M x_major = x2 > y2;
    return anisotropic(u, v, select(x_major, du_dx, du_dy), select(x_major, dv_dx, dv_dy), probes, lod,
                       extra_probes);
  }

  /// One isotropic filter at a level of detail.
  Vec4<F> filter(F u, F v, F lod, std::uint64_t& extra_probes) const {
    return filter_lanes(u, v, lod, valid_, extra_probes);
  }

 private:
  Vec4<F> filter_lanes(F u, F v, F lod, M lanes, std::uint64_t& extra_probes) const {
    const Sampler& s = texture_.sampler;
    const M magnified = lod <= F(0.0f);
    const F top(static_cast<float>(texture_.levels - 1));
    const F clamped = min(max(lod, F(0.0f)), top);
    if (s.mip == MipFilter::none) return level_filter(u, v, I(0), magnified, lanes);
    if (s.mip == MipFilter::nearest)
      return level_filter(u, v, to_int(floor(clamped + F(0.5f))), magnified, lanes);
    const F lower = floor(clamped);
    const F fraction = clamped - lower;
    const Vec4<F> fine = level_filter(u, v, to_int(lower), magnified, lanes);
    const M mixed = (fraction > F(0.0f)) & lanes;
    if (!any(mixed)) return fine;
    extra_probes += static_cast<std::uint64_t>(std::popcount(mask_bits(mixed)));
    const Vec4<F> coarse = level_filter(u, v, to_int(min(lower + F(1.0f), top)), magnified, mixed);
    return fine + (coarse - fine) * fraction;
  }

  Vec4<F> anisotropic(F u, F v, F axis_u, F axis_v, F probes, F lod, std::uint64_t& extra_probes) const {
    Vec4<F> sum = {F(0.0f), F(0.0f), F(0.0f), F(0.0f)};
    const F step = F(1.0f) / probes;
    for (int i = 0; i < texture_.sampler.max_anisotropy; ++i) {
      const F index(static_cast<float>(i));
      const M runs = (index < probes) & valid_;
      if (!any(runs)) break;
      if (i > 0) extra_probes += static_cast<std::uint64_t>(std::popcount(mask_bits(runs)));
      const F offset = (index + F(0.5f)) * step - F(0.5f);
      const Vec4<F> c = filter_lanes(u + axis_u * offset, v + axis_v * offset, lod, runs, extra_probes);
      const F weight = select(runs, step, F(0.0f));
      sum = sum + c * weight;
    }
    return sum;
  }

  Vec4<F> level_filter(F u, F v, I level, M magnified, M lanes) const {
    const I w = gather(texture_.width.data(), level), h = gather(texture_.height.data(), level);
    const F x = wrap(u, texture_.sampler.wrap_u) * to_float(w);
    const F y = wrap(v, texture_.sampler.wrap_v) * to_float(h);
    const bool mag_linear = texture_.sampler.mag == Filter::linear,
               min_linear = texture_.sampler.min == Filter::linear;
    if (!mag_linear && !min_linear) return nearest(x, y, w, h, level, lanes);
    const Vec4<F> smooth = bilinear(x, y, w, h, level, lanes);
    if (mag_linear && min_linear) return smooth;
    const Vec4<F> sharp = nearest(x, y, w, h, level, lanes);
    const M use_smooth = mag_linear ? magnified : !magnified;
    return {select(use_smooth, smooth.x, sharp.x), select(use_smooth, smooth.y, sharp.y),
            select(use_smooth, smooth.z, sharp.z), select(use_smooth, smooth.w, sharp.w)};
  }

  /// To [0, 1] for repeat and mirror; clamped modes keep the coordinate, within bounds that an int holds.
  static F wrap(F c, Wrap mode) {
    switch (mode) {
      case Wrap::repeat:
        return c - floor(c);
      case Wrap::mirrored_repeat: {
        const F t = c - F(2.0f) * floor(c * F(0.5f));
        return F(1.0f) - abs(F(1.0f) - t);
      }
      case Wrap::clamp_to_edge:
        return saturate_coordinate(c, 0.0f, 1.0f);
      case Wrap::clamp_to_border:
        return saturate_coordinate(c, -1.0f, 2.0f);
    }
    return c;
  }
  static F saturate_coordinate(F c, float low, float high) { return min(max(c, F(low)), F(high)); }

  /// The final clamp also keeps a coordinate that was not a number inside the level.
  static I wrap_texel(I i, I size, Wrap mode) {
    const I last = size - I(1);
    if (mode == Wrap::repeat) {
      const I raised = i + select(i < I(0), size, I(0));
      i = raised - select(raised > last, size, I(0));
    }
    return min(max(i, I(0)), last);
  }

  Vec4<F> nearest(F x, F y, I w, I h, I level, M lanes) const {
    return texel(to_int(floor(x)), to_int(floor(y)), w, h, level, lanes);
  }

  Vec4<F> bilinear(F x, F y, I w, I h, I level, M lanes) const {
    const F left = floor(x - F(0.5f)), top = floor(y - F(0.5f));
    const F fx = x - F(0.5f) - left, fy = y - F(0.5f) - top;
    const I x0 = to_int(left), y0 = to_int(top), x1 = x0 + I(1), y1 = y0 + I(1);
    const Vec4<F> c00 = texel(x0, y0, w, h, level, lanes), c10 = texel(x1, y0, w, h, level, lanes);
    const Vec4<F> c01 = texel(x0, y1, w, h, level, lanes), c11 = texel(x1, y1, w, h, level, lanes);
    const Vec4<F> upper = c00 + (c10 - c00) * fx, lower = c01 + (c11 - c01) * fx;
    return upper + (lower - upper) * fy;
  }

  Vec4<F> texel(I x, I y, I w, I h, I level, M lanes) const {
    const I xi = wrap_texel(x, w, texture_.sampler.wrap_u), yi = wrap_texel(y, h, texture_.sampler.wrap_v);
    const I tiles_x = gather(texture_.tiles_x.data(), level);
    const I first = gather(texture_.first_texel.data(), level);
    const I tile = shift_right<2>(yi) * tiles_x + shift_right<2>(xi);
    const I index = first + shift_left<4>(tile) + shift_left<2>(yi & I(3)) + (xi & I(3));
    const I safe = select(lanes, index, I(0));
    if (tracker_ != nullptr) {
      const I line = shift_right<4>(safe) + I(static_cast<std::int32_t>(texture_.first_line));
      track_lines(*tracker_, line, mask_bits(lanes), first_lane_, 4);
    }
    const I code = gather(reinterpret_cast<const std::int32_t*>(texture_.texels), safe);
    return border(decode(code), x, y, w, h);
  }

  Vec4<F> decode(I code) const {
    const F scale(1.0f / 255.0f);
    const I r = code & I(255), g = shift_right<8>(code) & I(255), b = shift_right<16>(code) & I(255);
    const F a = to_float(shift_right<24>(code) & I(255)) * scale;
    if (!texture_.srgb) return {to_float(r) * scale, to_float(g) * scale, to_float(b) * scale, a};
    const float* table = srgb_decode_table().data();
    return {gather(table, r), gather(table, g), gather(table, b), a};
  }

  Vec4<F> border(Vec4<F> c, I x, I y, I w, I h) const {
    const Sampler& s = texture_.sampler;
    if (s.wrap_u != Wrap::clamp_to_border && s.wrap_v != Wrap::clamp_to_border) return c;
    M outside = F(1.0f) < F(0.0f);
    if (s.wrap_u == Wrap::clamp_to_border) outside = outside | (x < I(0)) | (x > w - I(1));
    if (s.wrap_v == Wrap::clamp_to_border) outside = outside | (y < I(0)) | (y > h - I(1));
    return {select(outside, F(s.border_color.x), c.x), select(outside, F(s.border_color.y), c.y),
            select(outside, F(s.border_color.z), c.z), select(outside, F(s.border_color.w), c.w)};
  }

  const TextureView& texture_;
  AccessTracker* tracker_;
  M valid_;
  int first_lane_;
};

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
