#include "algos/base/shaders/forward.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/base/shaders/forward.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"
#include "pipeline/shade/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {
namespace lanes = pipeline::HWY_NAMESPACE;

template <bool kAlphaTest>
struct ForwardShader {
  using Uniforms = ForwardUniforms;
  template <class S>
  static void run(S& s, const ForwardUniforms& u) {
    using F = typename S::F;
    auto material = lanes::sample_material(s, u.full_varyings);
    auto lit = s.valid();
    if constexpr (kAlphaTest) {
      const auto dropped = material.base.w < F(s.material().alpha_cutoff);
      s.discard(dropped);
      lit = lit & !dropped;
    }
    s.count(BaseCounters::lit_samples, lit & s.active());
    const auto position = s.attr3(pipeline::SurfaceVaryings::kPosition);
    const auto surface = lanes::make_surface(material, position, u.lighting.eye);
    const auto color = lanes::occlude_ambient(
        s, u.lighting, surface, lanes::light_surface(s, u.lighting, surface, lanes::lights_reach(s, lit)));
    s.output(0, {color.x, color.y, color.z, material.base.w});
  }
};

struct AlphaTestShader {
  using Uniforms = AlphaTestUniforms;
  template <class S>
  static void run(S& s, const AlphaTestUniforms&) {
    using F = typename S::F;
    s.discard(lanes::sample_alpha(s, 0) < F(s.material().alpha_cutoff));
  }
};

void run_forward(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<ForwardShader<false>>(b, u);
}
void run_forward_mask(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<ForwardShader<true>>(b, u);
}
void run_alpha_test(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<AlphaTestShader>(b, u);
}
}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_forward);
HWY_EXPORT(run_forward_mask);
HWY_EXPORT(run_alpha_test);

namespace {
template <bool kAlphaTest>
pipeline::FragmentProgram describe_forward(bool full, bool extended,
                                           void (*run)(pipeline::FragmentBatch&, const void*)) {
  ForwardUniforms uniforms;
  uniforms.lighting.extended = extended;
  pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::ForwardShader<kAlphaTest>>(
          kAlphaTest ? "forward_alpha_test" : "forward", run, uniforms);
  program.varying_scalars = full ? pipeline::SurfaceVaryings::kFull : pipeline::SurfaceVaryings::kBasic;
  program.can_discard = kAlphaTest;
  return program;
}
void call_forward(pipeline::FragmentBatch& b, const void* u) { HWY_DYNAMIC_DISPATCH(run_forward)(b, u); }
void call_forward_mask(pipeline::FragmentBatch& b, const void* u) {
  HWY_DYNAMIC_DISPATCH(run_forward_mask)(b, u);
}
void call_alpha_test(pipeline::FragmentBatch& b, const void* u) {
  HWY_DYNAMIC_DISPATCH(run_alpha_test)(b, u);
}
}  // namespace

const pipeline::FragmentProgram& forward_program(bool full_varyings, bool alpha_test, bool extended) {
  static const pipeline::FragmentProgram programs[] = {
      describe_forward<false>(false, false, call_forward),
      describe_forward<false>(true, false, call_forward),
      describe_forward<true>(false, false, call_forward_mask),
      describe_forward<true>(true, false, call_forward_mask),
      describe_forward<false>(false, true, call_forward),
      describe_forward<false>(true, true, call_forward),
      describe_forward<true>(false, true, call_forward_mask),
      describe_forward<true>(true, true, call_forward_mask)};
  return programs[(extended ? 4 : 0) + (alpha_test ? 2 : 0) + (full_varyings ? 1 : 0)];
}

const pipeline::FragmentProgram& alpha_test_program() {
  static const pipeline::FragmentProgram program = [] {
    pipeline::FragmentProgram p =
        pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::AlphaTestShader>("alpha_test",
                                                                                          call_alpha_test);
    p.varying_scalars = 2;
    p.can_discard = true;
    return p;
  }();
  return program;
}

}  // namespace hwsim::algos
#endif
