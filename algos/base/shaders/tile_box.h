#pragma once
// The box, in view space, around what a tile of the screen sees between two depths: lights whose spheres miss
// it reach no pixel of the tile.
#include <glm/glm.hpp>

namespace hwsim::algos {

struct TileBox {
  glm::vec3 low{1e30f}, high{-1e30f};  ///< empty
};

/// A frame cut into square tiles, in pixels.
struct TiledFrame {
  int width = 0, height = 0, tile_px = 16;
};
/// The least and the greatest depth of a tile's samples.
struct DepthRange {
  float nearest = 0.0f, farthest = 1.0f;
};

/// Depths are moved apart by more than a step of 24 bits: the surface lies beside what was stored.
TileBox tile_box(const TiledFrame& frame, glm::ivec2 tile, const glm::mat4& view_from_clip,
                 DepthRange depths);

}  // namespace hwsim::algos
