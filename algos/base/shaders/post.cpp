#include "algos/base/shaders/post.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/base/shaders/post.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {
namespace lanes = pipeline::HWY_NAMESPACE;

struct DownsampleShader {
  using Uniforms = DownsampleUniforms;
  template <class S>
  static void run(S& s, const DownsampleUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    const F zero(0.0f);
    lanes::Vec4<F> sum = {zero, zero, zero, zero};
    const I x = s.pixel_x() * I(u.factor), y = s.pixel_y() * I(u.factor);
    s.loop(1, u.factor * u.factor, s.valid(), [&](int i) HWY_ATTR {
      sum = sum + s.load_image(0, x + I(i % u.factor), y + I(i / u.factor), I(0));
    });
    s.output(0, sum * F(1.0f / static_cast<float>(u.factor * u.factor)));
  }
};

struct MergeShader {
  using Uniforms = MergeUniforms;
  template <class S>
  static void run(S& s, const MergeUniforms& u) {
    using F = typename S::F;
    const F zero(0.0f);
    lanes::Vec4<F> sum = {zero, zero, zero, zero};
    s.loop(1, u.samples, s.valid(),
           [&](int i) HWY_ATTR { sum = sum + s.load_image(0, s.pixel_x(), s.pixel_y(), typename S::I(i)); });
    s.output(0, sum * F(1.0f / static_cast<float>(u.samples)));
  }
};

struct ScaleShader {
  using Uniforms = ScaleUniforms;
  template <class S>
  static void run(S& s, const ScaleUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    s.output(0, s.load_image(0, s.pixel_x(), s.pixel_y(), I(0)) * F(u.scale));
  }
};

void run_downsample(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<DownsampleShader>(b, u);
}
void run_merge(pipeline::FragmentBatch& b, const void* u) { lanes::run_fragment_shader<MergeShader>(b, u); }
void run_scale(pipeline::FragmentBatch& b, const void* u) { lanes::run_fragment_shader<ScaleShader>(b, u); }
}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_downsample);
HWY_EXPORT(run_scale);
HWY_EXPORT(run_merge);

const pipeline::FragmentProgram& downsample_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::DownsampleShader>(
          "downsample", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_downsample)(b, u);
          });
  return program;
}

const pipeline::FragmentProgram& merge_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::MergeShader>(
          "merge", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_merge)
            (b, u);
          });
  return program;
}

const pipeline::FragmentProgram& scale_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::ScaleShader>(
          "scale", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_scale)
            (b, u);
          });
  return program;
}

}  // namespace hwsim::algos
#endif
