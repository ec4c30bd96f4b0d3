// The light that one aggregate of a pixel reflects (docs/techniques/agaa.md#shading). Per-target include
// guard, see simd/lanes-inl.h.
#include <hwy/highway.h>
#include "algos/agaa/shaders/lobes-inl.h"
#include "algos/agaa/shaders/programs.h"
#include "algos/agaa/shaders/record-inl.h"
#include "pipeline/shade/lighting-inl.h"
#if defined(HWSIM_ALGOS_AGAA_SHADERS_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_AGAA_SHADERS_LIGHT_INL_H_
#undef HWSIM_ALGOS_AGAA_SHADERS_LIGHT_INL_H_
#else
#define HWSIM_ALGOS_AGAA_SHADERS_LIGHT_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

/// Lighting has blocks 6 to 9 (shade/lighting-inl.h).
enum ShadeBlock : int {
  kAggregateBlock = 1,
  kOccupiedBlock = 2,
  kPositionBlock = 3,
  kGlossBlock = 4,
  kVarianceBlock = 5,
  kTapBlock = 10,
  kNormalBlock = 11,
  kNormalDotBlock = 12,
  kLobeBlock = 13,
  kSampleNormalBlock = 14,
  kDepthBlock = 15,
  kCovarianceBlock = 16
};

/// Lights one aggregate of every pixel.
template <class S>
class AggregateLight {
 public:
  using F = typename S::F;
  using I = typename S::I;
  using M = typename S::M;

  AggregateLight(S& s, const ShadeUniforms& u, int aggregate, M mask)
      : s_(s), u_(u), aggregate_(aggregate), mask_(mask) {
    if (u.aggregate.ndf == Ndf::lean) basis_ = pixel_basis<F>(u.aggregate.rays, s.pixel_x(), s.pixel_y());
  }

  /// `r`: normalized means.
  Vec3<F> run(const AggregateRecord<F, I>& r) {
    find_place(r);
    surface_.to_eye = normalize(-place_);
    surface_.position = place_ + constant<F>(u_.lighting.eye);
    surface_.albedo = r.albedo;
    surface_.emissive = {r.emissive, r.emissive, r.emissive};
    find_shape(r);
    const F chroma_scale(
        u_.aggregate.most_energy > 0.0f ? u_.aggregate.most_chroma_energy / u_.aggregate.most_energy : 1.0f);
    surface_.specular = decode_specular(r.luma, F(kNoChroma) + (r.cb - F(kNoChroma)) * chroma_scale,
                                        F(kNoChroma) + (r.cr - F(kNoChroma)) * chroma_scale);
    s_.uniform_branch(kLobeBlock, u_.diffuse != DiffuseFilter::off && !by_visible_normals(),
                      [&]() HWY_ATTR { lobe_ = diffuse_lobe(diffuse_length_); });
    return light();
  }

 private:
  // Mean and main axis of the samples' positions: along the pixel's ray, from the depths alone, that of
  // places with depths, or of their covariance (the paper's section 3.5.3).
  void find_place(const AggregateRecord<F, I>& r) {
    if (u_.aggregate.targets.moments >= 0) {
      place_along_ray(r.depth, r.depth2 - r.depth * r.depth);
      return;
    }
    place_by_depths(r);
    s_.uniform_branch(kCovarianceBlock, u_.covariance, [&]() HWY_ATTR { place_by_covariance(r); });
  }

  void place_along_ray(F mean, F variance) {
    const PixelRays& rays = u_.aggregate.rays;
    const F fx = to_float(s_.pixel_x()), fy = to_float(s_.pixel_y());
    const Vec3<F> ray = constant<F>(rays.first) + constant<F>(rays.per_x) * fx + constant<F>(rays.per_y) * fy;
    place_ = constant<F>(rays.origin) + constant<F>(rays.origin_per_x) * fx +
             constant<F>(rays.origin_per_y) * fy + ray * mean;
    spread_ = ray * sqrt(max(variance, F(0.0f)));
    if (u_.light_variance) {
      covariance_ = {F(0.0f), F(0.0f), F(0.0f), F(0.0f), F(0.0f), F(0.0f)};
      add_square(covariance_, spread_);
    }
  }

  void place_by_depths(const AggregateRecord<F, I>& r) {
    const I x = s_.pixel_x(), y = s_.pixel_y();
    const glm::vec4& d = u_.depth_of_z;
    F first(0.0f), sum(0.0f), squares(0.0f), count(0.0f);
    Slope slope{F(0.0f), F(0.0f), F(0.0f), F(0.0f), F(0.0f), F(0.0f)};
    s_.loop(kDepthBlock, u_.covariance ? 0 : u_.aggregate.samples, mask_, [&](int i) HWY_ATTR {
      const F z = s_.load_image(u_.depth_slot, x, y, I(i)).x;
      const M in = has_sample(r, x, y, i) & (z < F(1.0f));
      const F depth = (F(d.x) + F(d.y) * z) / (F(d.z) + F(d.w) * z);
      first = select(in & (count < F(0.5f)), depth, first);
      const F from_first = select(in, depth - first, F(0.0f));  // squares of depths would cancel
      count = count + select(in, F(1.0f), F(0.0f));
      sum = sum + from_first;
      squares = squares + from_first * from_first;
      if (u_.on_receiver) slope.add(u_.positions[static_cast<std::size_t>(i)], in, from_first);
    });
    const F share = F(1.0f) / max(count, F(1.0f));
    const F mean = sum * share;
    const F variance = squares * share - mean * mean;
    place_along_ray(first + mean, variance);
    if (u_.on_receiver) keep_on_receiver(slope, share, mean, first + mean, variance);
  }

  /// Sums over an aggregate's samples: their offsets in the pixel, those times depth, and their squares.
  struct Slope {
    F x, y, zx, zy, xx, yy;
    void add(pipeline::SamplePosition at, M in, F depth) {
      const F dx = select(in, F(static_cast<float>(at.x) * 0.0625f), F(0.0f)),
              dy = select(in, F(static_cast<float>(at.y) * 0.0625f), F(0.0f));
      x = x + dx;
      y = y + dy;
      zx = zx + dx * depth;
      zy = zy + dy * depth;
      xx = xx + dx * dx;
      yy = yy + dy * dy;
    }
  };

  /// The samples' mean place, and how it moves where their depth grows by a standard deviation: the
  /// covariance of places and depths. On one plane both lie in the plane, so that no tap goes below it; of
  /// samples whose depths have nothing to do with where in the pixel they are, the axis is the pixel's ray.
  /// `mean`: of depths from the first one; `depth`: of depths.
  void keep_on_receiver(const Slope& slope, F share, F mean, F depth, F variance) {
    const PixelRays& rays = u_.aggregate.rays;
    const F x = slope.x * share, y = slope.y * share;
    const F zx = slope.zx * share - mean * x, zy = slope.zy * share - mean * y;
    const Vec3<F> per_x = constant<F>(rays.origin_per_x) + constant<F>(rays.per_x) * depth,
                  per_y = constant<F>(rays.origin_per_y) + constant<F>(rays.per_y) * depth;
    from_center_ = per_x * x + per_y * y + constant<F>(rays.per_x) * zx + constant<F>(rays.per_y) * zy;
    const F inv_deviation = rsqrt(max(variance, F(1e-20f)));
    spread_ = spread_ + (per_x * zx + per_y * zy) * inv_deviation;
    // What no slope explains of the depths is curvature: the mean of a parabola lies 1.12 of these deviations
    // below its middle.
    const F xx = max(slope.xx * share - x * x, F(1e-6f)), yy = max(slope.yy * share - y * y, F(1e-6f));
    below_ = F(1.12f) * sqrt(max(variance - zx * zx / xx - zy * zy / yy, F(0.0f)));
  }

  void place_by_covariance(const AggregateRecord<F, I>& r) {
    const I x = s_.pixel_x(), y = s_.pixel_y();
    Vec3<F> first = {F(0.0f), F(0.0f), F(0.0f)}, sum = first;
    SymmetricMatrix<F> squares = {F(0.0f), F(0.0f), F(0.0f), F(0.0f), F(0.0f), F(0.0f)};
    F count(0.0f);
    s_.loop(kPositionBlock, u_.aggregate.samples, mask_, [&](int i) HWY_ATTR {
      const F z = s_.load_image(u_.depth_slot, x, y, I(i)).x;
      const M in = has_sample(r, x, y, i) & (z < F(1.0f));
      const Vec3<F> p = unproject(x, y, u_.positions[static_cast<std::size_t>(i)], z);
      first = select(in & (count < F(0.5f)), p, first);
      const F one = select(in, F(1.0f), F(0.0f));
      const Vec3<F> d =
          (p - first) * one;  // from the first one: squares of distances to the eye would cancel
      count = count + one;
      sum = sum + d;
      add_square(squares, d);
    });
    const F share = F(1.0f) / max(count, F(1.0f));
    const Vec3<F> mean = sum * share;
    place_ = first + mean;
    covariance_ = covariance(squares, mean, share);
    spread_ = main_axis(covariance_);
  }

  M has_sample(const AggregateRecord<F, I>& r, I x, I y, int i) {
    if (!u_.aggregate.targets.counts_samples) return (shift_right_by(r.mask, I(i)) & I(1)) != I(0);
    // Without masks the codes say which samples were meant.
    if (u_.aggregate.code_bits == 0) return mask_;
    const int bits = u_.aggregate.code_bits;
    const I codes = to_int(s_.load_image(u_.code_slot, x, y, I(i / 8)).x);
    return (shift_right_by(codes, I(i % 8 * bits)) & I((1 << bits) - 1)) == I(aggregate_);
  }

  Vec3<F> unproject(I x, I y, pipeline::SamplePosition p, F z) const {
    const F px = to_float(x) + F(0.5f + static_cast<float>(p.x) * 0.0625f);
    const F py = to_float(y) + F(0.5f + static_cast<float>(p.y) * 0.0625f);
    const F ndc_x = px * F(2.0f / static_cast<float>(u_.aggregate.width)) - F(1.0f);
    const F ndc_y = F(1.0f) - py * F(2.0f / static_cast<float>(u_.height));
    const glm::mat4& m = u_.eye_from_clip;
    const auto row = [&](int k) HWY_ATTR {
      return F(m[0][k]) * ndc_x + F(m[1][k]) * ndc_y + F(m[2][k]) * z + F(m[3][k]);
    };
    const F inv_w = F(1.0f) / row(3);
    return {row(0) * inv_w, row(1) * inv_w, row(2) * inv_w};
  }

  void find_shape(const AggregateRecord<F, I>& r) {
    switch (u_.aggregate.ndf) {
      case Ndf::toksvig: {
        const Vec3<F> v = {r.shape[0], r.shape[1], r.shape[2]};
        const F length2 = dot(v, v);
        length_ = min(sqrt(length2), F(1.0f - 1.0f / 65535.0f));
        surface_.normal = select(length2 > F(1e-12f), normalize(v), surface_.to_eye);  // opposed normals
        // The roughest material's vector has the least length that gloss alone gives: what is shorter than
        // that is spread for certain.
        matte_ = matte_exponent(u_.aggregate, r.albedo, max(r.luma, F(0.0f)));
        set_gloss(
            max(exponent_of(length_, u_.aggregate.gloss_reference) - matte_, F(u_.aggregate.least_exponent)));
        const F roughest = matte_ + F(u_.aggregate.least_exponent);
        diffuse_length_ = min(length_ * (roughest + F(1.0f)) / roughest, F(1.0f - 1.0f / 65535.0f));
        break;
      }
      case Ndf::lean:
        lean_ = make_lean(r.shape);
        surface_.normal = normalize(basis_.x * r.shape[0] + basis_.y * r.shape[1] + basis_.z);
        set_gloss(F(2.0f) / max(lean_.xx + lean_.yy, F(1e-5f)));
        diffuse_length_ = surface_.exponent / (surface_.exponent + F(1.0f));
        break;
      case Ndf::sggx:
        sggx_ = make_sggx(r.shape);
        surface_.normal = main_axis<6>(sggx_.s);
        surface_.normal = normalize(
            surface_.normal * select(dot(surface_.normal, surface_.to_eye) < F(0.0f), F(-1.0f), F(1.0f)));
        set_gloss(F(kLargestExponent));
        diffuse_length_ = F(1.0f);
        if (by_visible_normals()) find_visible_normals();
        break;
    }
    F own = surface_.exponent;
    bool separate = false;
    s_.uniform_branch(kGlossBlock, u_.aggregate.targets.geometric >= 0, [&]() HWY_ATTR {
      const F length = min(sqrt(dot(r.normal, r.normal)), F(1.0f - 1.0f / 65535.0f));
      if (u_.diffuse == DiffuseFilter::geometric) diffuse_length_ = length;
      if (!u_.separate_gloss || u_.aggregate.ndf != Ndf::toksvig) return;
      // Toksvig's factor on the mean gloss: steps 1 to 4 of the paper's section 3.5.2.
      const F s = exponent_of(min(r.gloss, F(1.0f - 1.0f / 65535.0f)), u_.aggregate.gloss_reference);
      const F factor = length / max(length + s * (F(1.0f) - length), F(1e-6f));
      surface_.normal = normalize(r.normal);
      set_gloss(s * factor);
      own = s;
      separate = true;
    });
    const F of_samples = mean_normal_length(r);
    if (u_.diffuse == DiffuseFilter::samples) diffuse_length_ = of_samples;
    set_own_scale(r, separate, own);
  }

  /// What of the lobe is the material's own. `own`: its exponent where that is stored; else of the whole
  /// lobe, from which the geometry's spread is taken where it is known.
  void set_own_scale(const AggregateRecord<F, I>& r, bool stored, F own) {
    const bool spread_known = u_.diffuse == DiffuseFilter::samples ||
                              u_.diffuse == DiffuseFilter::geometric ||
                              (u_.diffuse == DiffuseFilter::folded && u_.aggregate.ndf == Ndf::toksvig);
    const F longest(1.0f - 1.0f / 65535.0f);
    const float most = u_.aggregate.most_energy;
    if (u_.aggregate.ndf == Ndf::toksvig && most <= 0.0f) return;  // GGX's lobes are normalized
    switch (u_.aggregate.ndf) {
      case Ndf::toksvig:
        own_scale_ = F(kOwnLobeScale * most);  // the color holds what the materials' lobes reflect
        if (!u_.lighting.extended) return;
        if (spread_known && !stored)  // lengths multiply
          own = max(own, exponent_of(min(length_ / max(diffuse_length_, F(1e-6f)), longest),
                                     u_.aggregate.gloss_reference) -
                             matte_);
        own_energy_ = lobe_energy(own) * F(1.0f / most);
        break;
      case Ndf::lean:  // variances add: the spread's as slopes have it at the mean normal's tilt
        if (spread_known) {
          const F tilt = lean_.bx * lean_.bx + lean_.by * lean_.by;
          const F spread = (F(1.0f) / diffuse_length_ - F(1.0f)) * (F(1.0f) + tilt) * (F(2.0f) + tilt);
          // Twice: what a few planes leave of it must not pass for a rough material.
          own = F(2.0f) / max(lean_.xx + lean_.yy - F(2.0f) * spread, F(2.0f / kLargestExponent));
        }
        own_scale_ = F(0.25f) * (own + F(8.0f)) / max(own, F(0.125f));
        break;
      case Ndf::sggx: {  // the trace keeps the material's alpha^2 = 2/(s+2), whatever the normals
        const F a2 = max((r.shape[0] + r.shape[1] + r.shape[2] - F(1.0f)) * F(0.5f), F(1e-4f));
        own_scale_ = F(0.25f) * (F(1.0f) + F(3.0f) * a2);  // (s+8)/(s+2) of the density (s+2)/(2 pi)
        break;
      }
    }
  }

  /// SGGX's own way to diffuse light, in which the gloss is folded, too.
  bool by_visible_normals() const {
    return u_.aggregate.ndf == Ndf::sggx && u_.diffuse == DiffuseFilter::folded;
  }

  /// Length of the mean of the samples' normals: what geometry alone spreads them. No trips where it is not
  /// asked for.
  F mean_normal_length(const AggregateRecord<F, I>& r) {
    const I x = s_.pixel_x(), y = s_.pixel_y();
    Vec3<F> sum = {F(0.0f), F(0.0f), F(0.0f)};
    F count(0.0f);
    s_.loop(kSampleNormalBlock, u_.diffuse == DiffuseFilter::samples ? u_.aggregate.samples : 0, mask_,
            [&](int i) HWY_ATTR {
              const Vec4<F> code = s_.load_image(u_.normal_slot, x, y, I(i));
              const F one = select(has_sample(r, x, y, i), F(1.0f), F(0.0f));
              sum = sum + decode_pixel_normal(code.x, code.y) * one;
              count = count + one;
            });
    return min(sqrt(dot(sum, sum)) / max(count, F(1.0f)), F(1.0f - 1.0f / 65535.0f));
  }

  void set_gloss(F exponent) {
    surface_.exponent = min(exponent, F(kLargestExponent));
    surface_.alpha = sqrt(F(2.0f) / (surface_.exponent + F(2.0f)));
  }

  void find_visible_normals() {
    const SggxFrame<F> view = sggx_frame(sggx_, surface_.to_eye);
    s_.loop(kNormalBlock, u_.visible_normals, mask_, [&](int i) HWY_ATTR {
      const auto n = static_cast<std::size_t>(i);
      normals_[n] = visible_normal(view, constant<F>(u_.disk[n]));
    });
  }

  F diffuse(const Vec3<F>& l, const DiffuseLobe<F>& lobe) {
    const F mu = dot(surface_.normal, l);
    F result = max(mu, F(0.0f));
    if (by_visible_normals()) {
      F sum(0.0f);
      s_.loop(kNormalDotBlock, u_.visible_normals, mask_, [&](int i) HWY_ATTR {
        sum = sum + max(dot(normals_[static_cast<std::size_t>(i)], l), F(0.0f));
      });
      return sum * F(1.0f / static_cast<float>(u_.visible_normals));
    }
    // Without a block of its own: those of both loops over lights would add up in one.
    if (u_.diffuse != DiffuseFilter::off) result = diffuse_of(lobe, mu);
    return result;
  }

  /// Light from the unit direction l.
  Vec3<F> reflect(const Vec3<F>& l, const lanes::Surface<F>& surface, const DiffuseLobe<F>& lobe) {
    const bool ggx = u_.lighting.model == pipeline::ShadingModel::ggx;
    const Vec3<F> matte = surface.albedo * diffuse(l, lobe);
    switch (u_.aggregate.ndf) {
      case Ndf::toksvig:
        return matte + (ggx ? ggx_specular(surface, l) : blinn_phong_specular(surface, own_scale_, l));
      case Ndf::lean:
        return matte + lean_specular(surface, own_scale_, lean_, basis_, l, ggx);
      case Ndf::sggx:
        return matte + sggx_specular(surface, own_scale_, sggx_, l, ggx);
    }
    return matte;
  }

  /// Ambient light knows no lobe: it takes the specular color without the lobe's energy. Normals whose spread
  /// is not known pass for a rough lobe of too much energy, and no reflectance exceeds 1.
  lanes::Surface<F> by_color() const {
    lanes::Surface<F> surface = surface_;
    if (u_.lighting.extended && u_.aggregate.most_energy > 0.0f) {
      const Vec3<F>& c = surface_.specular;
      const F energy = max(max(own_energy_, F(1e-3f)), max(c.x, max(c.y, c.z)));
      surface.specular = c * (F(1.0f) / energy);
    }
    return surface;
  }

  /// Lobes as wide as the directions to a near light vary over the aggregate make them.
  void widen(const pipeline::PointLight& light, const Vec3<F>& l, lanes::Surface<F>& surface,
             DiffuseLobe<F>& lobe) const {
    const Vec3<F> d = constant<F>(light.position) - surface_.position;
    const F variance = across_variance(covariance_, l) / max(dot(d, d), F(1e-6f));
    const F own = F(1.0f) / max(surface.exponent, F(1e-3f));
    surface.exponent = min(F(1.0f) / max(own + variance, F(1e-6f)), F(kLargestExponent));
    surface.alpha = sqrt(F(2.0f) / (surface.exponent + F(2.0f)));
    if (u_.diffuse != DiffuseFilter::off)
      lobe = diffuse_lobe(diffuse_length_ / (F(1.0f) + variance * diffuse_length_));
  }

  Vec3<F> light() {
    const pipeline::LightingUniforms& lights = u_.lighting;
    Vec3<F> sum = surface_.emissive + lanes::ambient_light(lights, by_color());
    s_.loop(lanes::kDirectionalBlock, lights.directional_count, mask_, [&](int i) HWY_ATTR {
      const auto& light = lights.directional[static_cast<std::size_t>(i)];
      F visible(1.0f);
      s_.uniform_branch(lanes::kShadowBlock, light.shadowed && lights.shadow_slot >= 0,
                        [&]() HWY_ATTR { visible = filtered_shadow(); });
      sum =
          sum + reflect(constant<F>(light.to_light), surface_, lobe_) * (constant<F>(light.color) * visible);
    });
    const std::span points(lights.points.data(), s_.loop_count(lights.point_count));
    s_.loop(lanes::kPointBlock, static_cast<int>(points.size()), mask_, [&](int i) HWY_ATTR {
      const auto& light = points[static_cast<std::size_t>(i)];
      Vec3<F> l;
      const F attenuation = lanes::point_attenuation(light, surface_.position, l);
      s_.branch(lanes::kPointInRangeBlock, mask_ & (attenuation > F(0.0f)), [&]() HWY_ATTR {
        lanes::Surface<F> surface = surface_;
        DiffuseLobe<F> lobe = lobe_;
        s_.uniform_branch(kVarianceBlock, u_.light_variance && u_.aggregate.ndf == Ndf::toksvig,
                          [&]() HWY_ATTR { widen(light, l, surface, lobe); });
        sum = sum + reflect(l, surface, lobe) * (constant<F>(light.color) * attenuation);
      });
    });
    return sum;
  }

  /// Taps along the main axis, each compared as an ordinary receiver.
  F filtered_shadow() {
    F visible(0.0f);
    const Vec3<F> middle = u_.on_receiver
                               ? surface_.position + from_center_ +
                                     surface_.normal * (below_ * abs(dot(surface_.normal, surface_.to_eye)))
                               : surface_.position;
    s_.loop(kTapBlock, u_.shadow_taps, mask_, [&](int i) HWY_ATTR {
      const auto tap = static_cast<std::size_t>(i);
      const Vec3<F> p = middle + spread_ * F(u_.tap_position[tap]);
      visible =
          visible + lanes::shadow_visibility(s_, u_.lighting, p, surface_.normal) * F(u_.tap_weight[tap]);
    });
    return visible;
  }

  S& s_;
  const ShadeUniforms& u_;
  int aggregate_;
  M mask_;
  PixelBasis<F> basis_{};
  lanes::Surface<F> surface_{};
  Vec3<F> place_{}, spread_{};  ///< relative to the eye; standard deviation along the main axis
  F below_{};                   ///< how far the mean place lies below a curved surface, along the ray
  Vec3<F> from_center_{};       ///< the samples' mean place, from `place_` on the pixel's middle ray
  SymmetricMatrix<F> covariance_{};
  F length_{}, diffuse_length_{}, own_scale_{};
  F own_energy_{};  ///< what the own lobe reflects, over the most that one does
  F matte_{};       ///< what the stored exponent is beyond the lobe's
  DiffuseLobe<F> lobe_{};
  Lean<F> lean_{};
  Sggx<F> sggx_{};
  std::array<Vec3<F>, kMaxVisibleNormals> normals_{};
};

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
