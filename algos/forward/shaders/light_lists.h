#pragma once
// Lists of point lights, one a tile of 16x16 pixels (docs/techniques/forward.md#light-lists).
#include <glm/glm.hpp>

#include "algos/base/shaders/forward.h"
#include "pipeline/batch/program.h"

namespace hwsim::algos {

inline constexpr int kListTilePx = 16;

/// Tiles of a frame. A list is its length, then numbers of lights in growing order, with room for all.
struct TileGrid {
  int width = 0, height = 0;  ///< pixels
  int lights = 0;
  int columns() const { return (width + kListTilePx - 1) / kListTilePx; }
  int rows() const { return (height + kListTilePx - 1) / kListTilePx; }
  int list_words() const { return 1 + lights; }
  int words() const { return columns() * rows() * list_words(); }
};

/// A light: position, 1 / range^2, color; of spots also the cosine of the cone, axis and 1 / span.
inline constexpr int kLightWords = 12;
enum ListBuffer : int { kListsBuffer = 0, kLightsBuffer = 1 };

struct CullUniforms {
  TileGrid grid;
  int samples = 1;
  glm::mat4 view_from_world{1.0f}, view_from_clip{1.0f};
};
/// Depth in image slot 0; writes the lists.
const pipeline::ComputeProgram& cull_lights_program();

struct ListedForwardUniforms {
  ForwardUniforms forward;
  TileGrid grid;
  bool spots = false;  ///< some light has a cone
};
/// Material, directional lights and the tile's point lights; color 0 is linear RGBA.
const pipeline::FragmentProgram& listed_forward_program(bool full_varyings, bool extended);

}  // namespace hwsim::algos
