#pragma once
// Values as a picture to look at.
#include <cstdint>
#include <vector>

#include "pipeline/image/image.h"

namespace hwsim::pipeline {

/// Magma on the red channel divided by `full_scale`: three bytes a pixel, as a PNG file holds them.
std::vector<std::uint8_t> heat_map(const Image& values, float full_scale);

}  // namespace hwsim::pipeline
