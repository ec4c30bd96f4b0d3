// Samples of one-color pixels that have not been written yet: only sample 0 has. Per-target include guard.
#include "pipeline/memory/gpu_image.h"
#include "pipeline/simd/lanes-inl.h"

#if defined(HWSIM_MEMORY_STALE_SAMPLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_MEMORY_STALE_SAMPLES_INL_H_
#undef HWSIM_MEMORY_STALE_SAMPLES_INL_H_
#else
#define HWSIM_MEMORY_STALE_SAMPLES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// Copies sample 0 of `lanes` to the other samples.
inline void spread_lanes(GpuImage& image, int block, std::uint64_t lanes) {
  const auto* texels = reinterpret_cast<const std::int32_t*>(image.block(block));
  for (int first = 0; first < kBlockLanes; first += kVectorLanes) {
    if ((lanes >> first & kRegisterBits) == 0) continue;
    const auto mask = hn::RebindMask(DI(), mask_from_bits(lanes, first).v);
    for (int w = 0; w < image.words; ++w) {
      const LaneI color = load(texels + w * kBlockLanes + first);
      for (int s = 1; s < image.samples; ++s)
        hn::BlendedStore(
            color.v, mask, DI(),
            reinterpret_cast<std::int32_t*>(image.sample_of_block(block, s)) + w * kBlockLanes + first);
    }
  }
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
