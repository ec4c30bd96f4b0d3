// The merge of layers: their records of an aggregate become one.
#include "algos/agaa/shaders/programs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algos/agaa/shaders/merge.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "algos/agaa/shaders/pixel_groups-inl.h"
#include "algos/agaa/shaders/record-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

enum MergeBlock : int { kAggregateOfMergeBlock = 1, kLayerBlock = 2 };

/// Records hold sums: every target's channels add up, but the mask bytes of the layers stand side by side.
struct MergeLayersShader {
  using Uniforms = MergeLayersUniforms;
  template <class S>
  static void run(S& s, const MergeLayersUniforms& u) {
    using F = typename S::F;
    using I = typename S::I;
    const I x = s.pixel_x(), y = s.pixel_y();
    s.loop(kAggregateOfMergeBlock, u.aggregates, s.valid(), [&](int a) HWY_ATTR {
      std::array<Vec4<F>, pipeline::kMaxColorTargets> sum;
      for (Vec4<F>& v : sum) v = {F(0.0f), F(0.0f), F(0.0f), F(0.0f)};
      std::array<F, 4> mask = {F(0.0f), F(0.0f), F(0.0f), F(0.0f)};
      I samples(0);
      s.loop(kLayerBlock, u.layers, s.valid(), [&](int layer) HWY_ATTR {
        const I plane(layer * u.color_samples + a);
        const int shared[] = {u.from.shape, u.from.albedo,    u.from.chroma, u.from.shape_rest,
                              u.from.luma,  u.from.geometric, u.from.moments};
        for (const int t : shared) {
          if (t < 0) continue;
          const auto index = static_cast<std::size_t>(t);
          const Vec4<F> texel = s.load_image(t, x, y, plane);
          if (t == u.from.chroma) mask[static_cast<std::size_t>(layer)] = texel.w;
          sum[index] = sum[index] + texel;
        }
        if (u.from.mask_word >= 0)
          mask[static_cast<std::size_t>(layer)] = s.load_image(u.from.mask_word, x, y, plane).x;
        if (u.to.counts_samples)
          samples = samples + bit_count(byte_of<I>(mask[static_cast<std::size_t>(layer)]));
      });
      auto& chroma = sum[static_cast<std::size_t>(u.from.chroma)];
      chroma.w = u.to.counts_samples   ? to_float(samples) * F(1.0f / 255.0f)
                 : u.to.mask_word >= 0 ? F(0.0f)
                                       : mask[0];
      store(s, u, x, y, I(a), sum, mask);
    });
  }

  template <class S, class F, class I>
  static void store(S& s, const MergeLayersUniforms& u, I x, I y, I a,
                    const std::array<Vec4<F>, pipeline::kMaxColorTargets>& sum,
                    const std::array<F, 4>& mask) {
    const F zero(0.0f);
    // The same targets in the same places; what the layers' masks need besides follows.
    for (const int t :
         {u.to.shape, u.to.albedo, u.to.chroma, u.to.shape_rest, u.to.luma, u.to.geometric, u.to.moments})
      if (t >= 0) s.store_image(t, x, y, a, sum[static_cast<std::size_t>(t)], s.valid());
    if (u.to.mask_1 >= 0) s.store_image(u.to.mask_1, x, y, a, {mask[1], zero, zero, zero}, s.valid());
    if (u.to.mask_2 >= 0) s.store_image(u.to.mask_2, x, y, a, {mask[2], mask[3], zero, zero}, s.valid());
    if (u.to.mask_word >= 0)
      s.store_image(u.to.mask_word, x, y, a, {mask[0], mask[1], mask[2], mask[3]}, s.valid());
  }
};

void run_merge_layers(pipeline::GroupBatch& group, const void* u) {
  run_pixel_group<MergeLayersShader>(group, u);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::algos {
HWY_EXPORT(run_merge_layers);

const pipeline::ComputeProgram& agaa_merge_program() {
  static const pipeline::ComputeProgram program =
      HWY_NAMESPACE::describe_pixel_groups<HWY_NAMESPACE::MergeLayersShader>(
          "agaa_merge", [](pipeline::GroupBatch& g, const void* u) {
            HWY_DYNAMIC_DISPATCH(run_merge_layers)
            (g, u);
          });
  return program;
}

}  // namespace hwsim::algos
#endif
