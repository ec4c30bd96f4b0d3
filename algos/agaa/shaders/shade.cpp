// Shading of aggregates (docs/techniques/agaa.md#shading).
#include "algos/agaa/shaders/programs.h"
#include "pipeline/batch/fragment_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/agaa/shaders/shade.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/agaa/shaders/light-inl.h"
#include "algos/agaa/shaders/record-inl.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

template <bool kBuffer>
struct ShadeShader {
  using Uniforms = ShadeUniforms;
  template <class S>
  static void run(S& s, const ShadeUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    Vec3<F> color = {F(0.0f), F(0.0f), F(0.0f)};
    F covered(0.0f);
    s.loop(kAggregateBlock, u.aggregates, s.valid(), [&](int a) HWY_ATTR {
      AggregateRecord<F, I> r{};
      Vec4<F> chroma{};
      const auto load = [&](int target)
                            HWY_ATTR { return s.load_image(target, s.pixel_x(), s.pixel_y(), I(a)); };
      const I first =
          ((s.pixel_y() * I(u.aggregate.width) + s.pixel_x()) * I(u.aggregates) + I(a)) * I(kAggregateWords);
      if constexpr (kBuffer) {
        r.mask = s.load_buffer(0, first + I(kMaskWord), s.valid());
        r.count = to_float(bit_count(r.mask));
      } else {
        chroma = load(u.aggregate.targets.chroma);
        load_mask<F, I>(u.aggregate.targets, chroma, load, r);
      }
      const auto occupied = s.valid() & (r.count > F(0.5f));
      const F share = r.count * F(1.0f / static_cast<float>(u.aggregate.samples));
      covered = covered + share;
      s.branch(kOccupiedBlock, occupied, [&]() HWY_ATTR {
        if constexpr (kBuffer)
          load_words(s, u, first, r);
        else
          load_record<F, I>(u.aggregate.targets, u.aggregate.ndf, chroma, load, r);
        normalize_record(u, r, F(1.0f) / max(share, F(1e-6f)));
        const Vec3<F> lit = AggregateLight<S>(s, u, a, occupied).run(r);
        using lanes::saturate;
        const Vec3<F> shown = {saturate(lit.x), saturate(lit.y), saturate(lit.z)};
        color = color + shown * select(occupied, share, F(0.0f));
        s.count(BaseCounters::lit_samples, occupied);
      });
    });
    s.count(BaseCounters::lit_samples, !(covered > F(0.0f)));  // as pixels of other techniques count
    const Vec3<F> sky = constant<F>(u.background) * max(F(1.0f) - covered, F(0.0f));
    s.output(0, {color.x + sky.x, color.y + sky.y, color.z + sky.z, F(1.0f)});
  }

  template <class F, class I>
  static void normalize_record(const ShadeUniforms& u, AggregateRecord<F, I>& r, F scale) {
    for_each_scalar(u.aggregate.ndf, u.aggregate.targets.geometric >= 0, r,
                    [&](F& v, int) HWY_ATTR { v = v * scale; });
    if (u.aggregate.targets.moments >= 0) {
      r.depth = r.depth * scale;
      r.depth2 = r.depth2 * scale;
    }
  }

  template <class S, class F, class I>
  static void load_words(S& s, const ShadeUniforms& u, I first, AggregateRecord<F, I>& r) {
    for_each_scalar(u.aggregate.ndf, u.aggregate.targets.geometric >= 0, r, [&](F& v, int word) HWY_ATTR {
      v = to_float(s.load_buffer(0, first + I(word), s.valid())) * F(1.0f / kFixedPoint);
    });
  }
};

void run_shade(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<ShadeShader<false>>(b, u);
}
void run_shade_buffer(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<ShadeShader<true>>(b, u);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_shade);
HWY_EXPORT(run_shade_buffer);

namespace {
using pipeline::FragmentBatch;
using pipeline::FragmentProgram;
void call_shade(FragmentBatch& b, const void* u) { HWY_DYNAMIC_DISPATCH(run_shade)(b, u); }
void call_shade_buffer(FragmentBatch& b, const void* u) { HWY_DYNAMIC_DISPATCH(run_shade_buffer)(b, u); }

template <bool kBuffer>
FragmentProgram describe_shade(const ShadeVariant& variant, void (*run)(FragmentBatch&, const void*)) {
  ShadeUniforms uniforms;
  uniforms.aggregate.ndf = variant.ndf;
  uniforms.on_receiver = variant.on_receiver;
  if (variant.ndf == Ndf::toksvig) uniforms.aggregate.most_energy = 8.0f;
  uniforms.lighting.extended = variant.extended;
  if (variant.ndf != Ndf::toksvig) uniforms.aggregate.targets.shape_rest = 3;
  if (variant.ndf == Ndf::sggx) uniforms.aggregate.targets.luma = 4;
  return pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::ShadeShader<kBuffer>>(
      "agaa_shade", run, uniforms);
}
}  // namespace

const FragmentProgram& agaa_shade_program(const ShadeVariant& variant) {
  static const std::array<FragmentProgram, 24> programs = [] {
    std::array<FragmentProgram, 24> all;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const ShadeVariant v{static_cast<Ndf>(i / 8), (i & 1) != 0, (i & 2) != 0, (i & 4) != 0};
      all[i] = v.buffer ? describe_shade<true>(v, call_shade_buffer) : describe_shade<false>(v, call_shade);
    }
    return all;
  }();
  return programs[static_cast<std::size_t>(variant.ndf) * 8 + (variant.buffer ? 1u : 0u) +
                  (variant.on_receiver ? 2u : 0u) + (variant.extended ? 4u : 0u)];
}

}  // namespace hwsim::algos
#endif
