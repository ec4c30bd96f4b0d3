#include "algos/deferred/shaders/programs.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/deferred/shaders/programs.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/base/shaders/derivatives-inl.h"
#include "algos/base/shaders/gbuffer-inl.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {
namespace lanes = pipeline::HWY_NAMESPACE;

template <GBufferEncoding kEncoding, bool kAlphaTest>
struct GBufferShader {
  using Uniforms = GBufferUniforms;
  template <class S>
  static void run(S& s, const GBufferUniforms& u) {
    using F = typename S::F;
    using V = pipeline::SurfaceVaryings;
    const auto m = lanes::sample_material(s, u.full_varyings);
    if constexpr (kAlphaTest) s.discard(m.base.w < F(s.material().alpha_cutoff));
    const auto p = s.attr3(V::kPosition);
    GBufferValues<F> values{p,  m.normal, {m.base.x, m.base.y, m.base.z}, m.emissive, m.metallic, m.roughness,
                            {}, m.base.w};
    if constexpr (kEncoding != GBufferEncoding::compact) {
      const glm::mat4& v = u.view_from_world;
      const F z = F(v[0][2]) * p.x + F(v[1][2]) * p.y + F(v[2][2]) * p.z + F(v[3][2]);
      values.gradient = depth_gradient(z);
    }
    mark_unlit(s, u.extended, values);
    write_gbuffer<kEncoding>(s, values);
  }
};

enum DeferredBlock : int { kClassifyBlock = 1 };  // and the next one

template <GBufferEncoding kEncoding>
struct ClassifyShader {
  using Uniforms = DeferredUniforms;
  template <class S>
  static void run(S& s, const DeferredUniforms& u) {
    s.discard(!is_complex<kEncoding>(s, u, kClassifyBlock, s.pixel_x(), s.pixel_y(), s.layer() * u.samples));
  }
};

template <GBufferEncoding kEncoding>
struct DeferredLightShader {
  using Uniforms = DeferredUniforms;
  template <class S>
  static void run(S& s, const DeferredUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    const int index = s.layer() * u.samples + std::max(0, s.sample_index());
    const pipeline::SamplePosition p = u.positions[static_cast<std::size_t>(index)];
    const auto sample =
        read_gbuffer<kEncoding>(s, u, s.pixel_x(), s.pixel_y(), I(index),
                                F(static_cast<float>(p.x) * 0.0625f), F(static_cast<float>(p.y) * 0.0625f));
    const std::span points(u.lighting.points.data(), s.loop_count(u.lighting.point_count));
    s.output(0, light_sample(s, u, points, sample, s.valid()));
    s.count(BaseCounters::lit_samples, s.active());
  }
};

// One entry for each encoding, in the order of GBufferEncoding.
using E = GBufferEncoding;
template <class Shader>
void run(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<Shader>(b, u);
}
using Run = void (*)(pipeline::FragmentBatch&, const void*);
constexpr Run kGBuffer[] = {run<GBufferShader<E::gradients, false>>, run<GBufferShader<E::gradients, true>>,
                            run<GBufferShader<E::record, false>>,    run<GBufferShader<E::record, true>>,
                            run<GBufferShader<E::compact, false>>,   run<GBufferShader<E::compact, true>>,
                            run<GBufferShader<E::split, false>>,     run<GBufferShader<E::split, true>>};
constexpr Run kClassify[] = {run<ClassifyShader<E::gradients>>, run<ClassifyShader<E::record>>,
                             run<ClassifyShader<E::compact>>, run<ClassifyShader<E::split>>};
constexpr Run kLight[] = {run<DeferredLightShader<E::gradients>>, run<DeferredLightShader<E::record>>,
                          run<DeferredLightShader<E::compact>>, run<DeferredLightShader<E::split>>};

void run_gbuffer(int which, pipeline::FragmentBatch& b, const void* u) { kGBuffer[which](b, u); }
void run_classify(int which, pipeline::FragmentBatch& b, const void* u) { kClassify[which](b, u); }
void run_light(int which, pipeline::FragmentBatch& b, const void* u) { kLight[which](b, u); }
}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_gbuffer);
HWY_EXPORT(run_classify);
HWY_EXPORT(run_light);

namespace {
using pipeline::FragmentBatch;
using pipeline::FragmentProgram;
template <int kWhich>
void call_gbuffer(FragmentBatch& b, const void* u) {
  HWY_DYNAMIC_DISPATCH(run_gbuffer)(kWhich, b, u);
}
template <int kWhich>
void call_classify(FragmentBatch& b, const void* u) {
  HWY_DYNAMIC_DISPATCH(run_classify)(kWhich, b, u);
}
template <int kWhich>
void call_light(FragmentBatch& b, const void* u) {
  HWY_DYNAMIC_DISPATCH(run_light)(kWhich, b, u);
}

template <GBufferEncoding kEncoding, bool kAlphaTest>
FragmentProgram describe_gbuffer(bool full, bool extended) {
  GBufferUniforms uniforms;
  uniforms.extended = extended;
  constexpr int kWhich = 2 * static_cast<int>(kEncoding) + (kAlphaTest ? 1 : 0);
  FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::GBufferShader<kEncoding, kAlphaTest>>(
          kAlphaTest ? "gbuffer_alpha_test" : "gbuffer", call_gbuffer<kWhich>, uniforms);
  program.varying_scalars = full ? pipeline::SurfaceVaryings::kFull : pipeline::SurfaceVaryings::kBasic;
  program.can_discard = kAlphaTest;
  return program;
}

template <GBufferEncoding kEncoding>
FragmentProgram describe_classify() {
  FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::ClassifyShader<kEncoding>>(
          "classify", call_classify<static_cast<int>(kEncoding)>);
  program.can_discard = true;
  return program;
}

template <GBufferEncoding kEncoding>
FragmentProgram describe_light(bool extended) {
  DeferredUniforms uniforms;
  uniforms.lighting.extended = extended;
  return pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::DeferredLightShader<kEncoding>>(
      "deferred_light", call_light<static_cast<int>(kEncoding)>, uniforms);
}

/// The programs of one encoding; those for extended shading behind the others.
template <GBufferEncoding kEncoding>
struct EncodingPrograms {
  FragmentProgram gbuffer[8] = {
      describe_gbuffer<kEncoding, false>(false, false), describe_gbuffer<kEncoding, false>(true, false),
      describe_gbuffer<kEncoding, true>(false, false),  describe_gbuffer<kEncoding, true>(true, false),
      describe_gbuffer<kEncoding, false>(false, true),  describe_gbuffer<kEncoding, false>(true, true),
      describe_gbuffer<kEncoding, true>(false, true),   describe_gbuffer<kEncoding, true>(true, true)};
  FragmentProgram classify = describe_classify<kEncoding>();
  FragmentProgram light[2] = {describe_light<kEncoding>(false), describe_light<kEncoding>(true)};
};

template <class Result>
const FragmentProgram& choose(GBufferEncoding encoding, Result&& result) {
  static const EncodingPrograms<GBufferEncoding::gradients> gradients;
  static const EncodingPrograms<GBufferEncoding::record> record;
  static const EncodingPrograms<GBufferEncoding::compact> compact;
  static const EncodingPrograms<GBufferEncoding::split> split;
  switch (encoding) {
    case GBufferEncoding::gradients:
      return result(gradients);
    case GBufferEncoding::record:
      return result(record);
    case GBufferEncoding::compact:
      return result(compact);
    case GBufferEncoding::split:
      return result(split);
  }
  return result(gradients);
}
}  // namespace

const FragmentProgram& gbuffer_program(GBufferEncoding encoding, bool full_varyings, bool alpha_test,
                                       bool extended) {
  return choose(encoding, [&](const auto& programs) -> const FragmentProgram& {
    return programs.gbuffer[(extended ? 4 : 0) + (alpha_test ? 2 : 0) + (full_varyings ? 1 : 0)];
  });
}

const FragmentProgram& classify_program(GBufferEncoding encoding) {
  return choose(encoding, [](const auto& programs) -> const FragmentProgram& { return programs.classify; });
}

const FragmentProgram& deferred_light_program(GBufferEncoding encoding, bool extended) {
  return choose(encoding, [&](const auto& programs) -> const FragmentProgram& {
    return programs.light[extended ? 1 : 0];
  });
}

}  // namespace hwsim::algos
#endif
