// What a shader makes of its fragments' coverage: sample masks and alpha to coverage
// (docs/techniques/conventions.md#coverage, docs/techniques/forward.md#alpha-to-coverage). Per-target include
// guard.
#include "pipeline/emulate/pass_context.h"
#include "pipeline/raster/coverage-inl.h"
#include "pipeline/simd/lanes-inl.h"

#if defined(HWSIM_EMULATE_COVERAGE_OUTPUT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_EMULATE_COVERAGE_OUTPUT_INL_H_
#undef HWSIM_EMULATE_COVERAGE_OUTPUT_INL_H_
#else
#define HWSIM_EMULATE_COVERAGE_OUTPUT_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// Sample masks from alpha: the first k samples of a fixed order, k nearest to alpha * samples. Masks of
/// growing alpha are nested. Beyond eight samples the order goes round the groups of eight, so that layers of
/// a multicast pass and native samples take the same part each.
class AlphaCoverage {
 public:
  AlphaCoverage() = default;
  AlphaCoverage(int samples, int layer, int layers, bool dither)
      : total_(samples * layers), dither_(dither), masks_{} {
    const int groups = std::max(1, total_ / 8);
    for (int s = 0; s < samples; ++s) {
      const int index = layer * samples + s;
      const int rank = total_ <= 8 ? index : index % 8 * groups + index / 8;
      for (int k = rank + 1; k <= total_; ++k) masks_[static_cast<std::size_t>(k)] |= 1u << s;
    }
  }

  std::uint32_t mask(float alpha, int x, int y) const {
    if (!(alpha > 0.0f)) return 0;  // NaN too
    constexpr float kOffsets[4] = {0.125f, 0.625f, 0.875f, 0.375f};
    const float offset = dither_ ? kOffsets[(x & 1) + 2 * (y & 1)] : 0.5f;
    const float k = std::floor(std::min(alpha, 1.0f) * static_cast<float>(total_) + offset);
    return masks_[static_cast<std::size_t>(alpha >= 1.0f ? total_ : std::min(static_cast<int>(k), total_))];
  }

 private:
  int total_ = 1;
  bool dither_ = true;
  std::array<std::uint32_t, 2 * kMaxSamples + 1> masks_{};  ///< the mask for k samples, by k
};

/// The masks of a batch's fragments from color 0's alpha.
inline void alpha_to_output_mask(const AlphaCoverage& alpha, FragmentBatch& batch) {
  for (std::uint64_t lanes = batch.active_lanes; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(__builtin_ctzll(lanes));
    batch.output_mask[lane] = alpha.mask(batch.color[0][3][lane], batch.pixel_x[lane], batch.pixel_y[lane]);
  }
}

/// Lanes of a batch whose output mask has sample s.
inline std::uint64_t lanes_with_sample(const FragmentBatch& batch, int s) {
  std::uint64_t word = 0;
  const LaneI bit(static_cast<std::int32_t>(1u << s));
  for (int v = 0; v < kBlockVectors; ++v) {
    const auto* masks = reinterpret_cast<const std::int32_t*>(batch.output_mask.data()) + v * kVectorLanes;
    put_mask((load(masks) & bit) != LaneI(0), v, word);
  }
  return word & batch.active_lanes;
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
