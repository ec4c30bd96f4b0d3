#include "algos/skeleton/shaders/programs.h"

// The rest of the file is compiled once for each vector target, up to HWY_ONCE.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/skeleton/shaders/programs.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {
namespace lanes = pipeline::HWY_NAMESPACE;

/// The blocks of code that lanes may leave out; block 0 is the rest.
enum SkeletonBlock : int { kCompareBlock = 1, kMeanBlock = 2 };

struct SkeletonResolveShader {
  using Uniforms = SkeletonUniforms;

  /// One text for shading and for counting: S::F is a vector of floats, or a type that counts its operations.
  template <class S>
  static void run(S& s, const SkeletonUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    const auto sample = [&](int i) HWY_ATTR { return s.load_image(0, s.pixel_x(), s.pixel_y(), I(i)); };
    const lanes::Vec4<F> first = sample(0);
    F difference(0.0f);
    s.loop(kCompareBlock, u.samples - 1, s.valid(), [&](int i) HWY_ATTR {
      const lanes::Vec4<F> other = sample(i + 1);
      difference =
          max(difference, max(abs(other.x - first.x), max(abs(other.y - first.y), abs(other.z - first.z))));
    });
    const auto mixed = s.valid() & (F(u.tolerance) < difference);
    s.count(SkeletonCounters::skeleton_mixed_pixels, mixed);
    lanes::Vec4<F> color = first;
    s.branch(kMeanBlock, mixed, [&]() HWY_ATTR {
      lanes::Vec4<F> sum = first;
      const std::size_t others = s.loop_count(u.samples - 1);
      for (std::size_t i = 0; i < others; ++i) sum = sum + sample(static_cast<int>(i) + 1);
      const lanes::Vec4<F> mean = sum * F(1.0f / static_cast<float>(u.samples));
      color = {select(mixed, mean.x, first.x), select(mixed, mean.y, first.y), select(mixed, mean.z, first.z),
               select(mixed, mean.w, first.w)};
    });
    s.output(0, color);
  }
};

void run_skeleton_resolve(pipeline::FragmentBatch& b, const void* u) {
  lanes::run_fragment_shader<SkeletonResolveShader>(b, u);
}
}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_skeleton_resolve);

const pipeline::FragmentProgram& skeleton_resolve_program() {
  static const pipeline::FragmentProgram program =
      pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::SkeletonResolveShader>(
          "skeleton_resolve", [](pipeline::FragmentBatch& b, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_skeleton_resolve)(b, u);
          });
  return program;
}

}  // namespace hwsim::algos
#endif
