#include "pipeline/memory/gpu_image.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pipeline/memory/stale_samples.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/memory/stale_samples-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

void spread(GpuImage& image, int block) {
  const auto i = static_cast<std::size_t>(block);
  spread_lanes(image, block, image.stale_lanes[i]);
  image.stale_lanes[i] = 0;
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::pipeline {
HWY_EXPORT(spread);

void spread_stale_samples(GpuImage& image, int block_index) {
  HWY_DYNAMIC_DISPATCH(spread)(image, block_index);
}

}  // namespace hwsim::pipeline
#endif
