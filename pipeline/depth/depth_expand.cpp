// Depth tiles between their forms, for code outside of the bin kernels.
#include "pipeline/depth/depth_expand.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pipeline/depth/depth_expand.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/depth/depth_planes-inl.h"

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
}  // namespace hwsim::pipeline
#endif
