#pragma once
// Words of texels, whether the image's samples are packed or not.
#include <cstdint>

#include "pipeline/memory/gpu_image.h"

namespace hwsim::pipeline {

/// A word of a texel of a tile that is neither cleared nor held as planes.
std::uint32_t held_word(const GpuImage& image, int x, int y, int sample, int word);

}  // namespace hwsim::pipeline
