#include "algos/base/shaders/tile_box.h"

#include <algorithm>

namespace hwsim::algos {
namespace {

constexpr float kDepthStep = 0x1p-23f;

/// Rows 2 and 3 have no x and y in the cameras' projections.
float view_z(const glm::mat4& m, float depth) {
  return (m[2][2] * depth + m[3][2]) / (m[2][3] * depth + m[3][3]);
}

glm::vec2 view_xy(const TiledFrame& frame, const glm::mat4& m, glm::ivec2 px, float z) {
  const float ndc_x = 2.0f * static_cast<float>(px.x) / static_cast<float>(frame.width) - 1.0f;
  const float ndc_y = 1.0f - 2.0f * static_cast<float>(px.y) / static_cast<float>(frame.height);
  const bool perspective = m[2][3] != 0.0f;
  const float scale = perspective ? -z : 1.0f;
  return {m[0][0] * ndc_x * scale, m[1][1] * ndc_y * scale};
}

}  // namespace

TileBox tile_box(const TiledFrame& frame, glm::ivec2 tile, const glm::mat4& view_from_clip,
                 DepthRange depths) {
  const float z[] = {view_z(view_from_clip, std::max(depths.nearest - kDepthStep, 0.0f)),
                     view_z(view_from_clip, std::min(depths.farthest + kDepthStep, 1.0f))};
  TileBox box;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec2 px = (tile + glm::ivec2(corner & 1, corner >> 1 & 1)) * frame.tile_px;
    const float depth = z[corner >> 2];
    const glm::vec3 p(view_xy(frame, view_from_clip, px, depth), depth);
    box.low = glm::min(box.low, p);
    box.high = glm::max(box.high, p);
  }
  return box;
}

}  // namespace hwsim::algos
