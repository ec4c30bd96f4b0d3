#include "algos/shaders/deferred.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/shaders/deferred.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/shaders/gbuffer-inl.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {
namespace lanes = pipeline::HWY_NAMESPACE;

// Derivatives: lanes have their own, the counting type charges one subtraction.
inline pipeline::CountF ddx(pipeline::CountF a) { return min(a, a); }
inline pipeline::CountF ddy(pipeline::CountF a) { return min(a, a); }

template <bool kAlphaTest>
struct GBufferShader {
  using Uniforms = GBufferUniforms;
  template <class S>
  static void run(S& s, const GBufferUniforms& u) {
    using F = typename S::F;
    using V = pipeline::SurfaceVaryings;
    const auto m = lanes::sample_material(s, u.full_varyings);
    if constexpr (kAlphaTest) s.discard(m.base.w < F(s.material().alpha_cutoff));
    const auto p = s.attr3(V::kPosition);
    const glm::mat4& v = u.view_from_world;
    const F z = F(v[0][2]) * p.x + F(v[1][2]) * p.y + F(v[2][2]) * p.z + F(v[3][2]);
    const auto n = encode_normal(m.normal);
    const F emissive = m.emissive.x * F(0.2126f) + m.emissive.y * F(0.7152f) + m.emissive.z * F(0.0722f);
    const F limit(65504.0f);  // grazing angles overflow half floats
    s.output(0, {n.x, n.y, m.roughness, emissive});
    s.output(1, {m.base.x, m.base.y, m.base.z, m.metallic});
    s.output(2, {min(abs(ddx(z)), limit), min(abs(ddy(z)), limit), F(0.0f), F(0.0f)});
  }
};

enum DeferredBlock : int { kClassifyBlock = 1 };

struct ClassifyShader {
  using Uniforms = DeferredUniforms;
  template <class S>
  static void run(S& s, const DeferredUniforms& u) {
    s.discard(!is_complex(s, u, kClassifyBlock, s.pixel_x(), s.pixel_y()));
  }
};

struct DeferredLightShader {
  using Uniforms = DeferredUniforms;
  template <class S>
  static void run(S& s, const DeferredUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    const int index = s.sample_index() < 0 ? 0 : s.sample_index();
    const pipeline::SamplePosition p = u.positions[static_cast<std::size_t>(index)];
    const auto sample =
        read_gbuffer(s, u, s.pixel_x(), s.pixel_y(), I(index), F(static_cast<float>(p.x) * 0.0625f),
                     F(static_cast<float>(p.y) * 0.0625f));
    const std::span points(u.lighting.points.data(), s.loop_count(u.lighting.point_count));
    s.output(0, light_sample(s, u, points, sample, s.valid()));
  }
};

void run_gbuffer(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<GBufferShader<false>>(b, u);
}
void run_gbuffer_mask(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<GBufferShader<true>>(b, u);
}
void run_classify(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<ClassifyShader>(b, u);
}
void run_light(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<DeferredLightShader>(b, u);
}
}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_gbuffer);
HWY_EXPORT(run_gbuffer_mask);
HWY_EXPORT(run_classify);
HWY_EXPORT(run_light);

namespace {
using pipeline::FragmentBatch;
using pipeline::FragmentProgram;
void call_gbuffer(FragmentBatch& b, const void* u) { HWY_DYNAMIC_DISPATCH(run_gbuffer)(b, u); }
void call_gbuffer_mask(FragmentBatch& b, const void* u) { HWY_DYNAMIC_DISPATCH(run_gbuffer_mask)(b, u); }
void call_classify(FragmentBatch& b, const void* u) { HWY_DYNAMIC_DISPATCH(run_classify)(b, u); }
void call_light(FragmentBatch& b, const void* u) { HWY_DYNAMIC_DISPATCH(run_light)(b, u); }

template <bool kAlphaTest>
FragmentProgram describe_gbuffer(bool full, void (*run)(FragmentBatch&, const void*)) {
  FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::GBufferShader<kAlphaTest>>(
          kAlphaTest ? "gbuffer_alpha_test" : "gbuffer", run);
  program.varying_scalars = full ? pipeline::SurfaceVaryings::kFull : pipeline::SurfaceVaryings::kBasic;
  program.can_discard = kAlphaTest;
  return program;
}
}  // namespace

const FragmentProgram& gbuffer_program(bool full_varyings, bool alpha_test) {
  static const FragmentProgram programs[] = {
      describe_gbuffer<false>(false, call_gbuffer), describe_gbuffer<false>(true, call_gbuffer),
      describe_gbuffer<true>(false, call_gbuffer_mask), describe_gbuffer<true>(true, call_gbuffer_mask)};
  return programs[(alpha_test ? 2 : 0) + (full_varyings ? 1 : 0)];
}

const FragmentProgram& classify_program() {
  static const FragmentProgram program = [] {
    FragmentProgram p = pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::ClassifyShader>(
        "classify", call_classify);
    p.can_discard = true;
    return p;
  }();
  return program;
}

const FragmentProgram& deferred_light_program() {
  static const FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::DeferredLightShader>("deferred_light",
                                                                                            call_light);
  return program;
}

}  // namespace hwsim::algos
#endif
