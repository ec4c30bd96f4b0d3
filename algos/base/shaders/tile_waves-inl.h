// Compute groups of 16x16 invocations, one a pixel, whose waves are the quadrants of 8x8 pixels. Per-target
// include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>
#include "pipeline/shade/compute_lanes-inl.h"
#if defined(HWSIM_ALGOS_BASE_SHADERS_TILE_WAVES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_BASE_SHADERS_TILE_WAVES_INL_H_
#undef HWSIM_ALGOS_BASE_SHADERS_TILE_WAVES_INL_H_
#else
#define HWSIM_ALGOS_BASE_SHADERS_TILE_WAVES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

inline constexpr int kWaveTilePx = 16;

/// body(context) for each register of the group's waves, in a frame of this size: pixels outside are not
/// valid.
template <class Body>
HWY_INLINE void for_each_tile_register(pipeline::GroupBatch& group, int width, int height, Body&& body) {
  namespace lanes = pipeline::HWY_NAMESPACE;
  constexpr int kLanes = lanes::kVectorLanes;
  for (int wave = 0; wave < kWaveTilePx * kWaveTilePx / pipeline::kBatchLanes; ++wave) {
    const int left = group.group_x * kWaveTilePx + 8 * (wave & 1);
    const int top = group.group_y * kWaveTilePx + 8 * (wave >> 1);
    for (int first = 0; first < pipeline::kBatchLanes; first += kLanes) {
      HWY_ALIGN std::int32_t x[kLanes], y[kLanes];
      for (int lane = 0; lane < kLanes; ++lane) {
        x[lane] = left + pipeline::lane_x(first + lane);
        y[lane] = top + pipeline::lane_y(first + lane);
      }
      const lanes::LaneI px = lanes::load(x), py = lanes::load(y);
      const lanes::LaneM valid = (px < lanes::LaneI(width)) & (py < lanes::LaneI(height));
      lanes::ComputeLanes s(group, first, px, py, lanes::LaneI(0), valid);
      body(s);
    }
    lanes::end_wave(group, pipeline::kBatchLanes);
  }
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
