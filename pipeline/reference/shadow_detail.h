#pragma once
// How coarse a shadow map is in a picture: what its edges look like there.
#include <vector>

#include "pipeline/scene/scene.h"

namespace hwsim::pipeline {

struct ShadowDetail {
  double median_px = 0.0;     ///< a texel's side in the picture: half of what is seen has less
  double coarse_share = 0.0;  ///< share of what is seen whose texels are larger than kCoarseTexelPx
};
inline constexpr double kCoarseTexelPx = 10.0;

/// For the first `cameras` of the scene's cameras, in frames of this size; from rays through some of their
/// pixels. Zeros where nothing is seen. Empty where no light casts shadows.
std::vector<ShadowDetail> shadow_details(const Scene& scene, std::size_t cameras, int width_px, int height_px,
                                         int shadow_map_px);

}  // namespace hwsim::pipeline
