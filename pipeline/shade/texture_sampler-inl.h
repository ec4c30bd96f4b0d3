// Texture filtering on lanes. Per-target include guard, see shade/lanes-inl.h.
#include "pipeline/emulate/fragment_batch.h"
#include "pipeline/shade/lanes-inl.h"
#include "pipeline/shade/texture_view.h"

#if defined(HWSIM_SHADE_TEXTURE_SAMPLER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SHADE_TEXTURE_SAMPLER_INL_H_
#undef HWSIM_SHADE_TEXTURE_SAMPLER_INL_H_
#else
#define HWSIM_SHADE_TEXTURE_SAMPLER_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// Samples one texture for the lanes of `valid` (helpers included: they fetch too).
class TextureSampler {
 public:
  TextureSampler(const TextureView& texture, TextureTracker* tracker, LaneM valid)
      : texture_(texture), tracker_(tracker), valid_(valid), valid_bits_(mask_bits(valid)) {}

  /// u, v with their derivatives for one pixel to the right and down. Adds probes beyond one a lane to `extra_probes`.
  Vec4<LaneF> sample(LaneF u, LaneF v, LaneF du_dx, LaneF dv_dx, LaneF du_dy, LaneF dv_dy,
                     std::uint64_t& extra_probes) const {
    const LaneF w(static_cast<float>(texture_.width[0])), h(static_cast<float>(texture_.height[0]));
    const LaneF x2 = du_dx * w * (du_dx * w) + dv_dx * h * (dv_dx * h);
    const LaneF y2 = du_dy * w * (du_dy * w) + dv_dy * h * (dv_dy * h);
    const LaneF major2 = max(x2, y2), minor2 = max(min(x2, y2), LaneF(1e-12f));
    const int limit = texture_.sampler.max_anisotropy;
    if (limit <= 1) return filter(u, v, LaneF(0.5f) * log2(major2), extra_probes);
    const LaneF ratio = min(sqrt(max(major2, LaneF(1e-12f)) / minor2), LaneF(static_cast<float>(limit)));
    const LaneF probes = max(floor(ratio + LaneF(0.999f)), LaneF(1.0f));
    const LaneF lod = LaneF(0.5f) * log2(major2) - log2(probes);
    const LaneM x_major = x2 > y2;
    return anisotropic(u, v, select(x_major, du_dx, du_dy), select(x_major, dv_dx, dv_dy), probes, lod, extra_probes);
  }

  /// One isotropic filter at a level of detail.
  Vec4<LaneF> filter(LaneF u, LaneF v, LaneF lod, std::uint64_t& extra_probes) const {
    const Sampler& s = texture_.sampler;
    const LaneM magnified = lod <= LaneF(0.0f);
    const LaneF top(static_cast<float>(texture_.levels - 1));
    const LaneF clamped = min(max(lod, LaneF(0.0f)), top);
    if (s.mip == MipFilter::none) return level_filter(u, v, LaneI(0), magnified);
    if (s.mip == MipFilter::nearest) return level_filter(u, v, to_int(floor(clamped + LaneF(0.5f))), magnified);
    const LaneF lower = floor(clamped);
    const LaneF fraction = clamped - lower;
    const Vec4<LaneF> fine = level_filter(u, v, to_int(lower), magnified);
    const LaneM mixed = fraction > LaneF(0.0f);
    if (!any(mixed & valid_)) return fine;
    extra_probes += static_cast<std::uint64_t>(__builtin_popcount(mask_bits(mixed) & valid_bits_));
    const Vec4<LaneF> coarse = level_filter(u, v, to_int(min(lower + LaneF(1.0f), top)), magnified);
    return fine + (coarse - fine) * fraction;
  }

 private:
  Vec4<LaneF> anisotropic(LaneF u, LaneF v, LaneF axis_u, LaneF axis_v, LaneF probes, LaneF lod,
                          std::uint64_t& extra_probes) const {
    Vec4<LaneF> sum = {LaneF(0.0f), LaneF(0.0f), LaneF(0.0f), LaneF(0.0f)};
    const LaneF step = LaneF(1.0f) / probes;
    for (int i = 0; i < texture_.sampler.max_anisotropy; ++i) {
      const LaneF index(static_cast<float>(i));
      const LaneM runs = index < probes;
      const std::uint32_t running = mask_bits(runs) & valid_bits_;
      if (running == 0) break;
      if (i > 0) extra_probes += static_cast<std::uint64_t>(__builtin_popcount(running));
      const LaneF offset = (index + LaneF(0.5f)) * step - LaneF(0.5f);
      const Vec4<LaneF> c = filter(u + axis_u * offset, v + axis_v * offset, lod, extra_probes);
      const LaneF weight = select(runs, step, LaneF(0.0f));
      sum = sum + c * weight;
    }
    return sum;
  }

  Vec4<LaneF> level_filter(LaneF u, LaneF v, LaneI level, LaneM magnified) const {
    const LaneI w = gather(texture_.width.data(), level), h = gather(texture_.height.data(), level);
    const LaneF x = wrap(u, texture_.sampler.wrap_u) * to_float(w);
    const LaneF y = wrap(v, texture_.sampler.wrap_v) * to_float(h);
    const bool mag_linear = texture_.sampler.mag == Filter::linear, min_linear = texture_.sampler.min == Filter::linear;
    if (!mag_linear && !min_linear) return nearest(x, y, w, h, level);
    const Vec4<LaneF> smooth = bilinear(x, y, w, h, level);
    if (mag_linear && min_linear) return smooth;
    const Vec4<LaneF> sharp = nearest(x, y, w, h, level);
    const LaneM use_smooth = mag_linear ? magnified : !magnified;
    return {select(use_smooth, smooth.x, sharp.x), select(use_smooth, smooth.y, sharp.y),
            select(use_smooth, smooth.z, sharp.z), select(use_smooth, smooth.w, sharp.w)};
  }

  /// To [0, 1] for repeat and mirror; clamped modes keep the coordinate, within bounds that an int holds.
  static LaneF wrap(LaneF c, Wrap mode) {
    switch (mode) {
      case Wrap::repeat: return c - floor(c);
      case Wrap::mirrored_repeat: {
        const LaneF t = c - LaneF(2.0f) * floor(c * LaneF(0.5f));
        return LaneF(1.0f) - abs(LaneF(1.0f) - t);
      }
      case Wrap::clamp_to_edge: return saturate_coordinate(c, 0.0f, 1.0f);
      case Wrap::clamp_to_border: return saturate_coordinate(c, -1.0f, 2.0f);
    }
    return c;
  }
  static LaneF saturate_coordinate(LaneF c, float low, float high) { return min(max(c, LaneF(low)), LaneF(high)); }

  /// The final clamp also keeps a coordinate that was not a number inside the level.
  static LaneI wrap_texel(LaneI i, LaneI size, Wrap mode) {
    const LaneI last = size - LaneI(1);
    if (mode == Wrap::repeat) {
      const LaneI raised = i + select(i < LaneI(0), size, LaneI(0));
      i = raised - select(raised > last, size, LaneI(0));
    }
    return min(max(i, LaneI(0)), last);
  }

  Vec4<LaneF> nearest(LaneF x, LaneF y, LaneI w, LaneI h, LaneI level) const {
    return texel(to_int(floor(x)), to_int(floor(y)), w, h, level);
  }

  Vec4<LaneF> bilinear(LaneF x, LaneF y, LaneI w, LaneI h, LaneI level) const {
    const LaneF left = floor(x - LaneF(0.5f)), top = floor(y - LaneF(0.5f));
    const LaneF fx = x - LaneF(0.5f) - left, fy = y - LaneF(0.5f) - top;
    const LaneI x0 = to_int(left), y0 = to_int(top), x1 = x0 + LaneI(1), y1 = y0 + LaneI(1);
    const Vec4<LaneF> c00 = texel(x0, y0, w, h, level), c10 = texel(x1, y0, w, h, level);
    const Vec4<LaneF> c01 = texel(x0, y1, w, h, level), c11 = texel(x1, y1, w, h, level);
    const Vec4<LaneF> upper = c00 + (c10 - c00) * fx, lower = c01 + (c11 - c01) * fx;
    return upper + (lower - upper) * fy;
  }

  Vec4<LaneF> texel(LaneI x, LaneI y, LaneI w, LaneI h, LaneI level) const {
    const LaneI xi = wrap_texel(x, w, texture_.sampler.wrap_u), yi = wrap_texel(y, h, texture_.sampler.wrap_v);
    const LaneI tiles_x = gather(texture_.tiles_x.data(), level);
    const LaneI first = gather(texture_.first_texel.data(), level);
    const LaneI tile = shift_right<2>(yi) * tiles_x + shift_right<2>(xi);
    const LaneI index =
        first + shift_left<4>(tile) + shift_left<2>(yi & LaneI(3)) + (xi & LaneI(3));
    const LaneI safe = select(valid_, index, LaneI(0));
    track(safe);
    const LaneI code = gather(reinterpret_cast<const std::int32_t*>(texture_.texels), safe);
    return border(decode(code), x, y, w, h);
  }

  Vec4<LaneF> decode(LaneI code) const {
    const LaneF scale(1.0f / 255.0f);
    const LaneI r = code & LaneI(255), g = shift_right<8>(code) & LaneI(255), b = shift_right<16>(code) & LaneI(255);
    const LaneF a = to_float(shift_right<24>(code) & LaneI(255)) * scale;
    if (!texture_.srgb) return {to_float(r) * scale, to_float(g) * scale, to_float(b) * scale, a};
    const float* table = srgb_decode_table().data();
    return {gather(table, r), gather(table, g), gather(table, b), a};
  }

  Vec4<LaneF> border(Vec4<LaneF> c, LaneI x, LaneI y, LaneI w, LaneI h) const {
    const Sampler& s = texture_.sampler;
    if (s.wrap_u != Wrap::clamp_to_border && s.wrap_v != Wrap::clamp_to_border) return c;
    LaneM outside = LaneF(1.0f) < LaneF(0.0f);
    if (s.wrap_u == Wrap::clamp_to_border) outside = outside | (x < LaneI(0)) | (x > w - LaneI(1));
    if (s.wrap_v == Wrap::clamp_to_border) outside = outside | (y < LaneI(0)) | (y > h - LaneI(1));
    return {select(outside, LaneF(s.border_color.x), c.x), select(outside, LaneF(s.border_color.y), c.y),
            select(outside, LaneF(s.border_color.z), c.z), select(outside, LaneF(s.border_color.w), c.w)};
  }

  void track(LaneI index) const {
    if (tracker_ == nullptr) return;
    HWY_ALIGN std::int32_t indices[kVectorLanes];
    store(index, indices);
    std::uint32_t last = 0xffffffffu;
    for (std::uint32_t bits = valid_bits_; bits != 0; bits &= bits - 1) {
      const auto line = static_cast<std::uint32_t>(indices[__builtin_ctz(bits)]) / kTexelsPerLine;
      if (line == last) continue;
      tracker_->touch(texture_.first_line + line);
      last = line;
    }
  }

  const TextureView& texture_;
  TextureTracker* tracker_;
  LaneM valid_;
  std::uint32_t valid_bits_;
};

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
