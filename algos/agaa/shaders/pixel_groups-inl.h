// Compute programs of one invocation a pixel, in groups of 16x16: a shader is a struct with
//   template <class S> static void run(S& s, const Uniforms& uniforms)
// over ComputeLanes, counted on CountFragment. Per-target include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>
#include <string>
#include "algos/base/shaders/tile_waves-inl.h"
#include "pipeline/shade/count_fragment-inl.h"
#if defined(HWSIM_ALGOS_AGAA_SHADERS_PIXEL_GROUPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_AGAA_SHADERS_PIXEL_GROUPS_INL_H_
#undef HWSIM_ALGOS_AGAA_SHADERS_PIXEL_GROUPS_INL_H_
#else
#define HWSIM_ALGOS_AGAA_SHADERS_PIXEL_GROUPS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

/// Uniforms know the frame's width and height.
template <class Shader>
void run_pixel_group(pipeline::GroupBatch& group, const void* uniforms) {
  const auto& u = *static_cast<const typename Shader::Uniforms*>(uniforms);
  for_each_tile_register(group, u.width, u.height, [&](pipeline::HWY_NAMESPACE::ComputeLanes& s) HWY_ATTR {
    if (any(s.valid())) Shader::run(s, u);
  });
}

template <class Shader>
pipeline::ComputeProgram describe_pixel_groups(std::string name,
                                               void (*run)(pipeline::GroupBatch&, const void*)) {
  pipeline::HWY_NAMESPACE::CountFragment counter;
  Shader::run(counter, typename Shader::Uniforms{});
  pipeline::ComputeProgram program;
  program.name = std::move(name);
  program.run = run;
  program.ops = counter.blocks();
  program.block_count = counter.block_count();
  program.group_width = program.group_height = kWaveTilePx;
  return program;
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
