#include "algos/base/shaders/prepass.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/base/shaders/prepass.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"
#include "pipeline/shade/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {
namespace lanes = pipeline::HWY_NAMESPACE;

struct FullAlphaTestShader {
  using Uniforms = AlphaTestUniforms;
  template <class S>
  static void run(S& s, const AlphaTestUniforms&) {
    using F = typename S::F;
    const pipeline::MaterialView& m = s.material();
    F alpha = lanes::sample_alpha(s, lanes::uv_of(m.base_color_texture));
    s.uniform_branch(lanes::kVertexColorBlock, m.has_colors,
                     [&]() HWY_ATTR { alpha = alpha * s.attr(pipeline::SurfaceVaryings::kColor + 3); });
    s.discard(alpha < F(m.alpha_cutoff));
  }
};

void run_full_alpha_test(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<FullAlphaTestShader>(b, u);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_full_alpha_test);

const pipeline::FragmentProgram& full_alpha_test_program() {
  static const pipeline::FragmentProgram program = [] {
    pipeline::FragmentProgram p =
        pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::FullAlphaTestShader>(
            "full_alpha_test", [](pipeline::FragmentBatch& b, const void* u) {
              HWY_DYNAMIC_DISPATCH(run_full_alpha_test)(b, u);
            });
    p.varying_scalars = pipeline::SurfaceVaryings::kFull;
    return p;
  }();
  return program;
}

}  // namespace hwsim::algos
#endif
