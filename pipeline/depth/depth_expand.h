#pragma once
#include "pipeline/emulate/gpu_image.h"

namespace hwsim::pipeline {

/// The smallest form that holds a tile without loss. The tile is not marked as cleared.
DepthTileForm depth_tile_form(const GpuImage& image, int block_index);

}  // namespace hwsim::pipeline
