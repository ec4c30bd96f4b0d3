// Texture filtering on any lane type: the emulator's registers and the scalar of the ray-traced reference.
// Per-target include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>
#include <bit>
#include <cstdint>
#include "pipeline/access/access_tracker.h"
#include "pipeline/image/image.h"
#include "pipeline/simd/transcendental-inl.h"
#include "pipeline/simd/vec-inl.h"
#include "pipeline/texture/texture_view.h"
#if defined(HWSIM_TEXTURE_TEXTURE_SAMPLER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_TEXTURE_TEXTURE_SAMPLER_INL_H_
#undef HWSIM_TEXTURE_TEXTURE_SAMPLER_INL_H_
#else
#define HWSIM_TEXTURE_TEXTURE_SAMPLER_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// block_hash of hwsim/trace/reuse.h, in every lane.
template <class I>
HWY_INLINE I line_hash(I line) {
  I h = line * I(static_cast<std::int32_t>(0x9e3779b1u));
  h = h ^ (shift_right<15>(h) & I(0x1ffff));
  return h * I(static_cast<std::int32_t>(0x85ebca77u));
}

/// Lanes whose line belongs to the sample: in most registers none.
template <class I>
HWY_INLINE std::uint32_t sampled_lines(const AccessTracker& tracker, I line, std::uint32_t lanes) {
  const int shift = tracker.kinds[index_of(ReuseStream::texture)].shift;
  const I high(static_cast<std::int32_t>(~(0xffffffffu >> shift)));
  return mask_bits((line_hash(line) & high) == I(0)) & lanes;
}
/// Notes the lines of lanes `sampled`.
template <class I>
HWY_INLINE void note_lines(AccessTracker& tracker, I line, std::uint32_t sampled, int first_lane,
                           std::uint32_t bytes) {
  for_each_lane(line, sampled, [&](int lane, std::int32_t number) HWY_ATTR {
    tracker.use((first_lane + lane) / 4, ReuseStream::texture, static_cast<std::uint32_t>(number), bytes, 0);
  });
}
template <class I>
HWY_INLINE void track_lines(AccessTracker& tracker, I line, std::uint32_t lanes, int first_lane,
                            std::uint32_t bytes) {
  const std::uint32_t sampled = sampled_lines(tracker, line, lanes);
  if (sampled != 0) note_lines(tracker, line, sampled, first_lane, bytes);
}
/// Texture coordinates and their change for one pixel to the right and down.
template <class F>
struct TextureSite {
  F u, v, du_dx, dv_dx, du_dy, dv_dy;
};

/// Samples one texture for the lanes of `valid` (helpers included: they fetch too). A lane fetches what it
/// needs itself, not what its neighbors in a register need: otherwise counts would depend on the register's
/// width. Value: Vec4<F>, or F for alpha alone, which spares the colors' decoding.
template <class F, class I, class M, class Value = Vec4<F>>
class TextureSampler {
 public:
  /// `first_lane`: of the register within its batch.
  TextureSampler(const TextureView& texture, AccessTracker* tracker, M valid, int first_lane = 0)
      : texture_(texture), tracker_(tracker), valid_(valid), first_lane_(first_lane) {}

  /// u, v with their derivatives for one pixel to the right and down. Adds probes beyond one a lane to
  /// `extra_probes`.
  Value sample(F u, F v, F du_dx, F dv_dx, F du_dy, F dv_dy, std::uint64_t& extra_probes) const {
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
  Value filter(F u, F v, F lod, std::uint64_t& extra_probes) const {
    return filter_lanes(u, v, lod, valid_, extra_probes);
  }

 private:
  Value filter_lanes(F u, F v, F lod, M lanes, std::uint64_t& extra_probes) const {
    const Sampler& s = texture_.sampler;
    const M magnified = lod <= F(0.0f);
    const F top(static_cast<float>(texture_.levels - 1));
    const F clamped = min(max(lod, F(0.0f)), top);
    if (s.mip == MipFilter::none) return level_filter(u, v, I(0), magnified, lanes);
    if (s.mip == MipFilter::nearest)
      return level_filter(u, v, to_int(floor(clamped + F(0.5f))), magnified, lanes);
    const F lower = floor(clamped);
    const F fraction = clamped - lower;
    const Value fine = level_filter(u, v, to_int(lower), magnified, lanes);
    const M mixed = (fraction > F(0.0f)) & lanes;
    if (!any(mixed)) return fine;
    extra_probes += static_cast<std::uint64_t>(std::popcount(mask_bits(mixed)));
    const Value coarse = level_filter(u, v, to_int(min(lower + F(1.0f), top)), magnified, mixed);
    return fine + (coarse - fine) * fraction;
  }

  Value anisotropic(F u, F v, F axis_u, F axis_v, F probes, F lod, std::uint64_t& extra_probes) const {
    Value sum;
    set_zero(sum);
    const F step = F(1.0f) / probes;
    for (int i = 0; i < texture_.sampler.max_anisotropy; ++i) {
      const F index(static_cast<float>(i));
      const M runs = (index < probes) & valid_;
      if (!any(runs)) break;
      if (i > 0) extra_probes += static_cast<std::uint64_t>(std::popcount(mask_bits(runs)));
      const F offset = (index + F(0.5f)) * step - F(0.5f);
      const Value c = filter_lanes(u + axis_u * offset, v + axis_v * offset, lod, runs, extra_probes);
      const F weight = select(runs, step, F(0.0f));
      sum = sum + c * weight;
    }
    return sum;
  }

  static void set_zero(F& value) { value = F(0.0f); }
  static void set_zero(Vec4<F>& value) { value = {F(0.0f), F(0.0f), F(0.0f), F(0.0f)}; }
  static F choose(M m, F a, F b) { return select(m, a, b); }
  static Vec4<F> choose(M m, const Vec4<F>& a, const Vec4<F>& b) {
    return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z), select(m, a.w, b.w)};
  }

  /// A level of the texture, in each lane.
  struct Level {
    I width, height, tiles_x, first_texel;
  };
  Level find_level(I level) const {
    const TextureView& t = texture_;
    const std::int32_t number = first_value(level);
    const auto i = static_cast<std::size_t>(number);
    if (!any(level != I(number)))
      return {I(t.width[i]), I(t.height[i]), I(t.tiles_x[i]), I(t.first_texel[i])};
    return {gather(t.width.data(), level), gather(t.height.data(), level), gather(t.tiles_x.data(), level),
            gather(t.first_texel.data(), level)};
  }

  Value level_filter(F u, F v, I number, M magnified, M lanes) const {
    const Level level = find_level(number);
    const F x = wrap(u, texture_.sampler.wrap_u) * to_float(level.width);
    const F y = wrap(v, texture_.sampler.wrap_v) * to_float(level.height);
    const bool mag_linear = texture_.sampler.mag == Filter::linear,
               min_linear = texture_.sampler.min == Filter::linear;
    if (!mag_linear && !min_linear) return nearest(x, y, level, lanes);
    const Value smooth = bilinear(x, y, level, lanes);
    if (mag_linear && min_linear) return smooth;
    const Value sharp = nearest(x, y, level, lanes);
    return choose(mag_linear ? magnified : !magnified, smooth, sharp);
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

  /// A texel's place: that of its column and that of its row.
  I column(I x, const Level& level) const {
    const I i = wrap_texel(x, level.width, texture_.sampler.wrap_u);
    return shift_left<4>(shift_right<2>(i)) + (i & I(3));
  }
  I row(I y, const Level& level) const {
    const I i = wrap_texel(y, level.height, texture_.sampler.wrap_v);
    return level.first_texel + shift_left<4>(shift_right<2>(i) * level.tiles_x) + shift_left<2>(i & I(3));
  }

  Value nearest(F x, F y, const Level& level, M lanes) const {
    const I xi = to_int(floor(x)), yi = to_int(floor(y));
    const I place = select(lanes, row(yi, level) + column(xi, level), I(0));
    if (tracker_ != nullptr) track_lines(*tracker_, line_of(place), mask_bits(lanes), first_lane_, 4);
    return texel(place, xi, yi, level);
  }

  Value bilinear(F x, F y, const Level& level, M lanes) const {
    const F left = floor(x - F(0.5f)), top = floor(y - F(0.5f));
    const F fx = x - F(0.5f) - left, fy = y - F(0.5f) - top;
    const I x0 = to_int(left), y0 = to_int(top), x1 = x0 + I(1), y1 = y0 + I(1);
    const I column0 = column(x0, level), column1 = column(x1, level);
    const I row0 = row(y0, level), row1 = row(y1, level);
    const I p00 = select(lanes, row0 + column0, I(0)), p10 = select(lanes, row0 + column1, I(0));
    const I p01 = select(lanes, row1 + column0, I(0)), p11 = select(lanes, row1 + column1, I(0));
    if (tracker_ != nullptr) track_four(p00, p10, p01, p11, mask_bits(lanes));
    const Value c00 = texel(p00, x0, y0, level), c10 = texel(p10, x1, y0, level);
    const Value c01 = texel(p01, x0, y1, level), c11 = texel(p11, x1, y1, level);
    const Value upper = c00 + (c10 - c00) * fx, lower = c01 + (c11 - c01) * fx;
    return upper + (lower - upper) * fy;
  }

  I line_of(I place) const {
    return shift_right<4>(place) + I(static_cast<std::int32_t>(texture_.first_line));
  }
  void track_four(I p00, I p10, I p01, I p11, std::uint32_t lanes) const {
    const I line[4] = {line_of(p00), line_of(p10), line_of(p01), line_of(p11)};
    std::uint32_t sampled[4];
    for (int i = 0; i < 4; ++i) sampled[i] = sampled_lines(*tracker_, line[i], lanes);
    if ((sampled[0] | sampled[1] | sampled[2] | sampled[3]) == 0) return;
    for (int i = 0; i < 4; ++i) note_lines(*tracker_, line[i], sampled[i], first_lane_, 4);
  }

  Value texel(I place, I x, I y, const Level& level) const {
    const I code = gather(reinterpret_cast<const std::int32_t*>(texture_.texels), place);
    Value value;
    decode(code, value);
    border(x, y, level, value);
    return value;
  }

  void decode(I code, F& alpha) const { alpha = to_float(shift_right<24>(code) & I(255)) * F(1.0f / 255.0f); }
  void decode(I code, Vec4<F>& c) const {
    const F scale(1.0f / 255.0f);
    const I r = code & I(255), g = shift_right<8>(code) & I(255), b = shift_right<16>(code) & I(255);
    decode(code, c.w);
    const float* table = srgb_decode_table().data();
    c.x = texture_.srgb ? gather(table, r) : to_float(r) * scale;
    c.y = texture_.srgb ? gather(table, g) : to_float(g) * scale;
    c.z = texture_.srgb ? gather(table, b) : to_float(b) * scale;
  }

  static Vec4<F> color_of(const glm::vec4& c, const Vec4<F>&) { return {F(c.x), F(c.y), F(c.z), F(c.w)}; }
  static F color_of(const glm::vec4& c, const F&) { return F(c.w); }

  void border(I x, I y, const Level& level, Value& c) const {
    const Sampler& s = texture_.sampler;
    if (s.wrap_u != Wrap::clamp_to_border && s.wrap_v != Wrap::clamp_to_border) return;
    M outside = F(1.0f) < F(0.0f);
    if (s.wrap_u == Wrap::clamp_to_border) outside = outside | (x < I(0)) | (x > level.width - I(1));
    if (s.wrap_v == Wrap::clamp_to_border) outside = outside | (y < I(0)) | (y > level.height - I(1));
    c = choose(outside, color_of(s.border_color, c), c);
  }

  const TextureView& texture_;
  AccessTracker* tracker_;
  M valid_;
  int first_lane_;
};

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
