#pragma once
// The smaller levels of a texture.
#include <cstdint>
#include <vector>

#include "pipeline/scene/scene.h"

namespace hwsim::pipeline {

/// Level 0 and all smaller ones down to 1x1, box filtered: a texel is the mean of the area of the level above
/// that it covers, in linear light where `srgb`. Integer sums over tables, so the same texels everywhere; off
/// the exact rounding by at most one code.
std::vector<MipLevel> mip_chain(int width, int height, std::vector<std::uint32_t> texels, bool srgb);

}  // namespace hwsim::pipeline
