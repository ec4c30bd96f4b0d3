#pragma once
// The features of a GPU that can do everything.
#include "hwsim/gpu/gpu_features.h"

namespace hwsim {

/// A GPU with what the papers ask for beyond DirectX 11: tests and studies run every path on it.
inline GpuFeatures every_feature(int native_msaa_max) {
  GpuFeatures features;
  features.native_msaa_max = native_msaa_max;
  features.coverage_samples_max = 32;
  features.target_independent_raster = true;
  features.post_depth_coverage = true;
  features.coverage_override = true;
  features.viewport_multicast = true;
  features.programmable_sample_positions = true;
  features.conservative_raster = true;
  features.float_atomics = true;
  return features;
}

}  // namespace hwsim
