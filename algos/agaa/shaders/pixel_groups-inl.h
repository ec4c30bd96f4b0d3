// Compute programs of one invocation a pixel, in groups of 16x16: a shader is a struct with
//   template <class S> static void run(S& s, const Uniforms& uniforms)
// over ComputeLanes, counted on CountFragment. Per-target include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>
#include <string>
#include "pipeline/shade/compute_lanes-inl.h"
#include "pipeline/shade/count_fragment-inl.h"
#if defined(HWSIM_ALGOS_AGAA_SHADERS_PIXEL_GROUPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_AGAA_SHADERS_PIXEL_GROUPS_INL_H_
#undef HWSIM_ALGOS_AGAA_SHADERS_PIXEL_GROUPS_INL_H_
#else
#define HWSIM_ALGOS_AGAA_SHADERS_PIXEL_GROUPS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

inline constexpr int kPixelGroupPx = 16;

/// Waves are the 8x8 quadrants of the group; uniforms know the frame's width and height.
template <class Shader>
void run_pixel_group(pipeline::GroupBatch& group, const void* uniforms) {
  namespace lanes = pipeline::HWY_NAMESPACE;
  constexpr int kLanes = lanes::kVectorLanes;
  const auto& u = *static_cast<const typename Shader::Uniforms*>(uniforms);
  for (int wave = 0; wave < 4; ++wave) {
    const int left = group.group_x * kPixelGroupPx + 8 * (wave & 1);
    const int top = group.group_y * kPixelGroupPx + 8 * (wave >> 1);
    for (int first = 0; first < pipeline::kBatchLanes; first += kLanes) {
      HWY_ALIGN std::int32_t x[kLanes], y[kLanes];
      for (int lane = 0; lane < kLanes; ++lane) {
        x[lane] = left + pipeline::lane_x(first + lane);
        y[lane] = top + pipeline::lane_y(first + lane);
      }
      const lanes::LaneI px = lanes::load(x), py = lanes::load(y);
      const lanes::LaneM valid = (px < lanes::LaneI(u.width)) & (py < lanes::LaneI(u.height));
      if (!any(valid)) continue;
      lanes::ComputeLanes s(group, first, px, py, lanes::LaneI(0), valid);
      Shader::run(s, u);
    }
    lanes::end_wave(group, pipeline::kBatchLanes);
  }
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
  program.group_width = program.group_height = kPixelGroupPx;
  return program;
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
