// Depth tiles between their forms, for code outside of the bin kernels.
#include "pipeline/memory/depth_expand.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pipeline/memory/depth_expand.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/memory/depth_planes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

void expand(GpuImage& image, int block) {
  expand_planes({image, block, image.block_x(block), image.block_y(block), depth_scale(image.format)});
}
DepthTileForm form(const GpuImage& image, int block) { return form_of(image, block); }

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::pipeline {
HWY_EXPORT(expand);
HWY_EXPORT(form);

void expand_depth_tile(GpuImage& image, int block_index) { HWY_DYNAMIC_DISPATCH(expand)(image, block_index); }
DepthTileForm depth_tile_form(const GpuImage& image, int block_index) {
  return HWY_DYNAMIC_DISPATCH(form)(image, block_index);
}

std::uint32_t stored_depth(const GpuImage& image, int block_index, int sample, int lane) {
  const auto i = static_cast<std::size_t>(block_index);
  if (image.cleared[i] != 0) return image.clear_words[0];
  const std::uint64_t* lanes =
      image.plane_lanes.data() + static_cast<std::ptrdiff_t>(block_index * kMaxDepthPlanes * image.samples);
  for (std::size_t p = 0; p < image.plane_count[i]; ++p) {
    if ((lanes[p * static_cast<std::size_t>(image.samples) + static_cast<std::size_t>(sample)] >> lane & 1) ==
        0)
      continue;
    const DepthPlane& plane = image.planes[i * kMaxDepthPlanes + p];
    return plane_depth_at(plane.z, plane.reference_x, plane.reference_y,
                          image.block_x(block_index) + lane_x(lane),
                          image.block_y(block_index) + lane_y(lane),
                          image.plane_positions[static_cast<std::size_t>(sample)], depth_scale(image.format));
  }
  return image.block(block_index)[sample * kBlockLanes + lane];
}

}  // namespace hwsim::pipeline
#endif
