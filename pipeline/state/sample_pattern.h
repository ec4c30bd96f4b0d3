#pragma once
// Where the samples of a pixel lie.
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/state/pipeline_state.h"

namespace hwsim::pipeline {

inline constexpr int kMaxSamples = 32;

/// The standard positions for 1, 2, 4, 8 and 16 samples (Direct3D 11 and Vulkan), and for 32 the set that
/// four shifted 8x passes reach (docs/techniques/forward.md#multicast), in index order. Throws
/// std::invalid_argument for other counts.
std::span<const SamplePosition> standard_sample_positions(int samples);

/// Where attributes of a partly covered pixel are taken: at the first covered sample of an order.
struct CentroidRule {
  std::span<const SamplePosition> positions{};
  std::span<const std::uint8_t> order{};  ///< empty: that of the indices
};

/// The rule of a standard pattern: from the center outward. That is the order of its indices but for 32
/// samples, whose indices go layer by layer: the first covered one lay 0.29 of a pixel up and left in the
/// mean over edges, so that native 32x looked worse than no anti-aliasing (FLIP in sponza_hall 0.0298,
/// 0.0294). Throws as above.
CentroidRule standard_centroid(int samples);

/// The standard positions for `samples`, then those for `positions` without the ones nearest to them. Samples
/// out of the larger pattern lie worse: dragon at 4 of 16 has 45.3 dB by its samples alone there, 48.1 dB
/// here. For 2 of 4, 4 of 8, 4 or 8 of 16, and 8 of 32. Throws as above.
std::vector<SamplePosition> coverage_positions(int samples, int positions);

/// How passes of eight samples reach more (docs/techniques/forward.md#multicast): every layer has the same
/// positions, squeezed into a part of the pixel, under a viewport of its own.
struct MulticastPattern {
  std::vector<SamplePosition> positions;  ///< the same in each layer
  std::vector<ViewportShift> viewports;   ///< one a layer
};
/// For 16 or 32 samples. Throws std::invalid_argument for other counts.
MulticastPattern multicast_pattern(int samples);

/// Where the samples of all layers lie in the pixel, in order of layer and sample: against the viewports'
/// shifts. For 32 samples these are the standard positions.
std::vector<SamplePosition> effective_positions(const MulticastPattern& pattern);

}  // namespace hwsim::pipeline
