#include "algos/agaa/uniforms.h"

#include <algorithm>
#include <cmath>

namespace hwsim::algos {

// From two planes of constant view depth.
PixelRays center_rays(const pipeline::Camera& camera, const glm::mat4& view_from_clip, int width,
                      int height) {
  const glm::mat3 world_from_view = glm::transpose(glm::mat3(camera.view_from_world));
  const auto at = [&](float x, float y, float z) {
    const glm::vec4 p =
        view_from_clip * glm::vec4(2.0f * (x + 0.5f) / static_cast<float>(width) - 1.0f,
                                   1.0f - 2.0f * (y + 0.5f) / static_cast<float>(height), z, 1.0f);
    return glm::vec3(p) / p.w;
  };
  const auto direction = [&](float x, float y) {
    const glm::vec3 a = at(x, y, 0.25f), b = at(x, y, 0.75f);
    return (b - a) / (a.z - b.z);
  };
  const auto origin = [&](float x, float y) {
    const glm::vec3 a = at(x, y, 0.25f);
    return a + direction(x, y) * a.z;
  };
  PixelRays rays;
  rays.first = world_from_view * direction(0, 0);
  rays.per_x = world_from_view * (direction(1, 0) - direction(0, 0));
  rays.per_y = world_from_view * (direction(0, 1) - direction(0, 0));
  rays.origin = world_from_view * origin(0, 0);
  rays.origin_per_x = world_from_view * (origin(1, 0) - origin(0, 0));
  rays.origin_per_y = world_from_view * (origin(0, 1) - origin(0, 0));
  return rays;
}

// Quantiles of a normal distribution at the middles of equal shares; three taps as
// docs/techniques/agaa.md#shading has them.
void set_shadow_taps(ShadeUniforms& u, int taps) {
  static constexpr float kQuantiles[kMaxShadowTaps][kMaxShadowTaps] = {
      {0.0f},
      {-0.674f, 0.674f},
      {-1.0f, 0.0f, 1.0f},
      {-1.150f, -0.319f, 0.319f, 1.150f},
      {-1.282f, -0.524f, 0.0f, 0.524f, 1.282f},
      {-1.383f, -0.674f, -0.210f, 0.210f, 0.674f, 1.383f},
      {-1.465f, -0.792f, -0.366f, 0.0f, 0.366f, 0.792f, 1.465f},
      {-1.534f, -0.887f, -0.489f, -0.157f, 0.157f, 0.489f, 0.887f, 1.534f}};
  u.shadow_taps = taps;
  for (std::size_t i = 0; i < static_cast<std::size_t>(taps); ++i) {
    u.tap_position[i] = kQuantiles[taps - 1][i];
    u.tap_weight[i] = taps == 3 ? (i == 1 ? 0.5f : 0.25f) : 1.0f / static_cast<float>(taps);
  }
}

// Hammersley points over the disk.
void set_hemisphere(ShadeUniforms& u, int visible_normals) {
  u.visible_normals = visible_normals;
  for (int i = 0; i < visible_normals; ++i) {
    float turn = 0.0f, digit = 0.5f;
    for (int bits = i; bits != 0; bits >>= 1, digit *= 0.5f) turn += (bits & 1) != 0 ? digit : 0.0f;
    const float r = std::sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(visible_normals));
    const float phi = 6.2831853f * turn, x = r * std::cos(phi), y = r * std::sin(phi);
    u.disk[static_cast<std::size_t>(i)] = {x, y, std::sqrt(std::max(0.0f, 1.0f - x * x - y * y))};
  }
}

}  // namespace hwsim::algos
