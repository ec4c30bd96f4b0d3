// The passes of AGAA that draw: visibility, and generation of the aggregate G-buffer.
#include "algos/agaa/shaders/programs.h"
#include "pipeline/batch/fragment_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/agaa/shaders/geometry.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/agaa/shaders/record-inl.h"
#include "algos/base/shaders/derivatives-inl.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"
#include "pipeline/shade/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

template <bool kAlpha>
struct VisibilityShader {
  using Uniforms = VisibilityUniforms;
  template <class S>
  static void run(S& s, const VisibilityUniforms& u) {
    using F = typename S::F;
    using V = pipeline::GeometryVaryings;
    // Positions at any points of the plane will do: the cross product of their differences is normal to it.
    const auto p = s.attr3(V::kPosition);
    const Vec3<F> across = {ddx(p.x), ddx(p.y), ddx(p.z)}, down = {ddy(p.x), ddy(p.y), ddy(p.z)};
    const auto basis = pixel_basis<F>(u.rays, s.pixel_x(), s.pixel_y());
    const auto code = encode_pixel_normal(basis, normalize(cross(across, down)));
    F alpha(1.0f);
    if constexpr (kAlpha) alpha = lanes::sample_alpha(s, V::kUv0);
    s.output(0, {code.x, code.y, F(0.0f), alpha});
  }
};

enum GenerateBlock : int { kCodeBlock = 6, kGeometricBlock = 7, kMomentsBlock = 8 };

/// A sphere of microflakes would have no axis: alpha^2 of SGGX.
inline constexpr float kMaxFlakeVariance = 0.8f;

template <class F>
F gloss_of(F exponent, const AggregateUniforms& u) {
  const F s = max(exponent, F(u.least_exponent));
  const float reference = u.gloss_reference;
  if (reference <= 0.0f) return s / (s + F(1.0f));
  return s * F(reference) / (F(reference) - s + s * F(reference));
}

template <class F, class I>
void set_shape(const AggregateUniforms& u, const PixelBasis<F>& basis, const lanes::Surface<F>& surface,
               const Vec3<F>& n, F luma, F weight, AggregateRecord<F, I>& r) {
  switch (u.ndf) {
    case Ndf::toksvig: {
      const F own = max(surface.exponent, F(u.least_exponent));
      const F length = gloss_of(own + matte_exponent(u, surface.albedo, luma), u) * weight;
      r.shape[0] = n.x * length;
      r.shape[1] = n.y * length;
      r.shape[2] = n.z * length;
      break;
    }
    case Ndf::lean: {
      const F inv_z = F(1.0f) / max(dot(n, basis.z), F(1e-3f));
      F bx = dot(n, basis.x) * inv_z, by = dot(n, basis.y) * inv_z;
      const F scale = min(F(1.0f), F(4.0f) * rsqrt(max(bx * bx + by * by, F(1e-12f))));
      bx = bx * scale;
      by = by * scale;
      const F own = F(1.0f) / max(surface.exponent, F(u.least_exponent));
      r.shape[0] = bx * weight;
      r.shape[1] = by * weight;
      r.shape[2] = (bx * bx + own) * weight;
      r.shape[3] = (by * by + own) * weight;
      r.shape[4] = bx * by * weight;
      break;
    }
    case Ndf::sggx: {
      const F a2 = min(surface.alpha * surface.alpha, F(kMaxFlakeVariance));
      const F outer = (F(1.0f) - a2) * weight, round = a2 * weight;
      r.shape[0] = n.x * n.x * outer + round;
      r.shape[1] = n.y * n.y * outer + round;
      r.shape[2] = n.z * n.z * outer + round;
      r.shape[3] = n.x * n.y * outer;
      r.shape[4] = n.x * n.z * outer;
      r.shape[5] = n.y * n.z * outer;
      break;
    }
  }
}

template <bool kAtomic>
struct GenerateShader {
  using Uniforms = GenerateUniforms;

  /// The aggregate of the fragment's first visible sample (Algorithm 2, 2c).
  template <class S>
  static typename S::I find_aggregate(S& s, const GenerateUniforms& u, typename S::I mask) {
    using I = typename S::I;
    I aggregate(0);
    const int bits = u.aggregate.code_bits;
    s.uniform_branch(kCodeBlock, bits > 0, [&]() HWY_ATTR {
      // A lane without coverage asks for the last sample: its texel exists, and nothing uses what it holds.
      const I first = min(lowest_bit(mask), I(u.raster_samples - 1));
      const I layer = shift_right<3>(first) + I(s.layer());
      const I codes = to_int(s.load_image(0, s.pixel_x(), s.pixel_y(), layer).x);
      aggregate = shift_right_by(codes, (first & I(7)) * I(bits)) & I((1 << bits) - 1);
      if constexpr (!kCounting<S>) count_mixed(s, u, mask, aggregate);
    });
    return aggregate;
  }

  /// Counts fragments whose samples belong to several aggregates: all of them go to the first's.
  template <class S>
  static void count_mixed(S& s, const GenerateUniforms& u, typename S::I mask, typename S::I aggregate) {
    using I = typename S::I;
    const auto& image = *s.batch().resources->images[0];
    const int bits = u.aggregate.code_bits;
    auto mixed = I(0) != I(0);
    for (int i = 0; i < u.raster_samples; ++i) {
      const I codes =
          to_int(lanes::load_texel(image, image.format, s.pixel_x(), s.pixel_y(), I(s.layer() + i / 8)).x);
      const I code = shift_right_by(codes, I(i % 8 * bits)) & I((1 << bits) - 1);
      mixed = mixed | (((shift_right_by(mask, I(i)) & I(1)) != I(0)) & (code != aggregate));
    }
    s.count(AgaaCounters::agaa_mixed_code_fragments, mixed);
  }

  template <class S>
  static void run(S& s, const GenerateUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    const AggregateUniforms& a = u.aggregate;
    const I mask = s.coverage();
    const I aggregate = find_aggregate(s, u, mask);
    const auto material = lanes::sample_material(s, u.full_varyings);
    lanes::Surface<F> surface;
    lanes::set_material(Vec3<F>{material.base.x, material.base.y, material.base.z}, material.metallic,
                        material.roughness, surface);
    AggregateRecord<F, I> r{};
    r.count = to_float(bit_count(mask));
    const F weight = r.count * F(1.0f / static_cast<float>(a.samples));
    PixelBasis<F> basis{};
    if (a.ndf == Ndf::lean) basis = pixel_basis<F>(a.rays, s.pixel_x(), s.pixel_y());
    encode_specular(surface.specular, r.luma, r.cb, r.cr);
    if (a.most_energy > 0.0f)
      scale_specular(a, lobe_energy(max(surface.exponent, F(a.least_exponent))), r.luma, r.cb, r.cr);
    set_shape(a, basis, surface, material.normal, r.luma, weight, r);
    r.luma = r.luma * weight;
    r.cb = r.cb * weight;
    r.cr = r.cr * weight;
    r.albedo = surface.albedo * weight;
    const F emissive = material.emissive.x * F(0.2126f) + material.emissive.y * F(0.7152f) +
                       material.emissive.z * F(0.0722f);
    r.emissive = min(emissive, F(1.0f)) * weight;
    r.mask = mask;
    const bool geometric = a.targets.geometric >= 0;
    s.uniform_branch(kGeometricBlock, geometric, [&]() HWY_ATTR {
      r.normal = material.normal * weight;
      r.gloss = gloss_of(surface.exponent, a) * weight;
    });
    s.uniform_branch(kMomentsBlock, a.targets.moments >= 0, [&]() HWY_ATTR {
      const auto p = s.attr3(pipeline::SurfaceVaryings::kPosition);
      const F depth =
          F(u.view_z_row.x) * p.x + F(u.view_z_row.y) * p.y + F(u.view_z_row.z) * p.z + F(u.view_z_row.w);
      r.depth = depth * weight;
      r.depth2 = depth * depth * weight;
    });
    if constexpr (kAtomic)
      accumulate(s, u, aggregate, geometric, r);
    else
      route(s, u, aggregate, r);
  }

  /// To the color sample that stands for the aggregate, by blending.
  template <class S, class F, class I>
  static void route(S& s, const GenerateUniforms& u, I aggregate, const AggregateRecord<F, I>& r) {
    emit_record(u.aggregate.targets, u.aggregate.ndf, r,
                [&](int target, const Vec4<F>& color) HWY_ATTR { s.output(target, color); });
    const int ratio = u.raster_samples / u.color_samples;
    const std::uint32_t block = ratio == 32 ? ~0u : (1u << ratio) - 1u;
    I samples(static_cast<std::int32_t>(block));
    for (int i = 1; i < u.color_samples; ++i)
      samples = select(aggregate == I(i), I(static_cast<std::int32_t>(block << (i * ratio))), samples);
    s.output_mask(samples);
  }

  /// To a storage buffer, in fixed point: integer sums do not depend on the order.
  template <class S, class F, class I>
  static void accumulate(S& s, const GenerateUniforms& u, I aggregate, bool geometric,
                         AggregateRecord<F, I>& r) {
    const I pixel = s.pixel_y() * I(u.aggregate.width) + s.pixel_x();
    const I first = (pixel * I(u.color_samples) + aggregate) * I(kAggregateWords);
    for_each_scalar(u.aggregate.ndf, geometric, r, [&](F& v, int word) HWY_ATTR {
      s.atomic_add(0, first + I(word), to_int(floor(v * F(kFixedPoint) + F(0.5f))), s.active());
    });
    s.atomic_add(0, first + I(kMaskWord), r.mask * I(static_cast<std::int32_t>(1u << (8 * s.layer()))),
                 s.active());
  }
};

void run_visibility(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<VisibilityShader<false>>(b, u);
}
void run_visibility_alpha(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<VisibilityShader<true>>(b, u);
}
void run_generate(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<GenerateShader<false>>(b, u);
}
void run_generate_atomic(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<GenerateShader<true>>(b, u);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_visibility);
HWY_EXPORT(run_visibility_alpha);
HWY_EXPORT(run_generate);
HWY_EXPORT(run_generate_atomic);

namespace {
using pipeline::FragmentBatch;
using pipeline::FragmentProgram;
void call_visibility(FragmentBatch& b, const void* u) { HWY_DYNAMIC_DISPATCH(run_visibility)(b, u); }
void call_visibility_alpha(FragmentBatch& b, const void* u) {
  HWY_DYNAMIC_DISPATCH(run_visibility_alpha)(b, u);
}
void call_generate(FragmentBatch& b, const void* u) { HWY_DYNAMIC_DISPATCH(run_generate)(b, u); }
void call_generate_atomic(FragmentBatch& b, const void* u) {
  HWY_DYNAMIC_DISPATCH(run_generate_atomic)(b, u);
}

template <bool kAlpha>
FragmentProgram describe_visibility(void (*run)(FragmentBatch&, const void*)) {
  FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::VisibilityShader<kAlpha>>(
          kAlpha ? "agaa_visibility_alpha" : "agaa_visibility", run);
  program.varying_scalars = pipeline::GeometryVaryings::kCount;
  return program;
}

template <bool kAtomic>
FragmentProgram describe_generate(Ndf ndf, bool full, void (*run)(FragmentBatch&, const void*)) {
  GenerateUniforms uniforms;
  uniforms.aggregate.ndf = ndf;
  if (ndf == Ndf::toksvig) uniforms.aggregate.most_energy = 8.0f;
  if (ndf != Ndf::toksvig) uniforms.aggregate.targets.shape_rest = 3;
  if (ndf == Ndf::sggx) uniforms.aggregate.targets.luma = 4;
  FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::GenerateShader<kAtomic>>(
          kAtomic ? "agaa_generate_atomic" : "agaa_generate", run, uniforms);
  program.varying_scalars = full ? pipeline::SurfaceVaryings::kFull : pipeline::SurfaceVaryings::kBasic;
  program.color_outputs = kAtomic ? 0 : pipeline::kMaxColorTargets;
  return program;
}
}  // namespace

const FragmentProgram& agaa_visibility_program(bool alpha) {
  static const FragmentProgram programs[] = {describe_visibility<false>(call_visibility),
                                             describe_visibility<true>(call_visibility_alpha)};
  return programs[alpha ? 1 : 0];
}

const FragmentProgram& agaa_generate_program(Ndf ndf, bool full_varyings, bool atomic) {
  static const std::array<FragmentProgram, 12> programs = [] {
    std::array<FragmentProgram, 12> all;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto shape = static_cast<Ndf>(i / 4);
      all[i] = (i & 1) != 0 ? describe_generate<true>(shape, (i & 2) != 0, call_generate_atomic)
                            : describe_generate<false>(shape, (i & 2) != 0, call_generate);
    }
    return all;
  }();
  return programs[static_cast<std::size_t>(ndf) * 4 + (full_varyings ? 2 : 0) + (atomic ? 1 : 0)];
}

}  // namespace hwsim::algos
#endif
