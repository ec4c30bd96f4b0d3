#pragma once
#include <span>
#include <vector>

#include "pipeline/graph/pipeline_state.h"

namespace hwsim::pipeline {

inline constexpr int kMaxSamples = 32;

/// The standard positions for 1, 2, 4, 8 and 16 samples (Direct3D 11 and Vulkan), and for 32 the set that
/// four shifted 8x passes reach (techniques 1.4), in index order. Throws std::invalid_argument for other
/// counts.
std::span<const SamplePosition> standard_sample_positions(int samples);

}  // namespace hwsim::pipeline
