#pragma once
// Depth of an 8x8 tile as plane equations: what plane compression stores, and what the emulator computes with
// (Hasselgren & Akenine-Moeller 2006; docs/compression.md#depth). A tile starts as one constant plane, the
// clear value. Each triangle that passes somewhere takes a slot, and samples of other planes move to it;
// planes without samples leave. A tile that needs more slots is expanded into its samples, and stays so until
// it is cleared or one plane covers it whole.
#include <cstdint>

#include "pipeline/raster/triangle.h"

namespace hwsim::pipeline {

inline constexpr int kMaxDepthPlanes = 4;

struct DepthPlane {
  PlaneEquation z;
  float reference_x = 0.0f, reference_y = 0.0f;  ///< as the triangle's
  std::uint32_t nearest = 0, farthest = 0;       ///< bounds over the part of the tile that it may cover

  bool same_plane(const DepthPlane& other) const {
    return z.base == other.z.base && z.ddx == other.z.ddx && z.ddy == other.z.ddy &&
           reference_x == other.reference_x && reference_y == other.reference_y;
  }
};

/// How a depth tile lies in memory when its unit's cache gives it back. Sizes depend on the GPU and are the
/// timing engines' business; `offset` keeps each sample's distance from the tile's nearest or farthest value,
/// in 6 bits (about a quarter of the raw size) or in 14 (about half).
enum class DepthTileForm : std::uint8_t {
  clear,
  one_plane,
  two_planes,
  four_planes,  ///< three or four
  offset_6,
  offset_14,
  raw
};
inline constexpr int kDepthTileForms = 7;

}  // namespace hwsim::pipeline
