#pragma once
// Tiles of 8x8 pixels: the lanes that kernels work on, and the order of pixels within them.

namespace hwsim::pipeline {

inline constexpr int kBlockPx = 8;      ///< depth, color and coarse-depth state is kept for 8x8 pixel tiles
inline constexpr int kBlockLanes = 64;  ///< pixels of a tile
inline constexpr int kQuadsPerBlock = 16;

/// Lane of pixel (x, y) within its tile, 0..7 each: quads are four consecutive lanes, and quads follow the
/// Morton order. So a vector register of any width holds whole quads.
constexpr int lane_of(int x, int y) {
  return (x & 1) | ((y & 1) << 1) | ((x & 2) << 1) | ((y & 2) << 2) | ((x & 4) << 2) | ((y & 4) << 3);
}
constexpr int lane_x(int lane) { return (lane & 1) | ((lane >> 1) & 2) | ((lane >> 2) & 4); }
constexpr int lane_y(int lane) { return ((lane >> 1) & 1) | ((lane >> 2) & 2) | ((lane >> 3) & 4); }

}  // namespace hwsim::pipeline
