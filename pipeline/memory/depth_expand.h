#pragma once
// Depth of a tile from its planes, one sample at a time.
#include "pipeline/memory/depth_format.h"
#include "pipeline/memory/gpu_image.h"

namespace hwsim::pipeline {

/// The smallest form that holds a tile without loss. The tile is not marked as cleared.
DepthTileForm depth_tile_form(const GpuImage& image, int block_index);

/// A plane at (x, y) from its reference point, as stored: one operation after the other, as the vector code
/// rounds.
inline std::uint32_t plane_depth_at(const PlaneEquation& z, float x, float y, float scale) {
  const float across = z.ddx * x, down = z.ddy * y;
  const float sum = z.base + down;
  const float plane = sum + across;
  return depth_bits(plane > 0.0f ? (plane < 1.0f ? plane : 1.0f) : 0.0f, scale);
}
/// The same at a position of a pixel.
inline std::uint32_t plane_depth_at(const PlaneEquation& z, float reference_x, float reference_y, int pixel_x,
                                    int pixel_y, SamplePosition position, float scale) {
  return plane_depth_at(
      z, (static_cast<float>(pixel_x) - reference_x) + 0.5f + static_cast<float>(position.x) * 0.0625f,
      (static_cast<float>(pixel_y) - reference_y) + 0.5f + static_cast<float>(position.y) * 0.0625f, scale);
}

/// The depth of a sample, whichever form its tile is held in.
std::uint32_t stored_depth(const GpuImage& image, int block_index, int sample, int lane);

}  // namespace hwsim::pipeline
