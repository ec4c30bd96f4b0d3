#include "pipeline/scene/shadow_view.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace hwsim::pipeline {
namespace {

// A turn alone: a step back along the light would be one meter in a scene of any size.
glm::mat4 turned_to(const glm::vec3& to_light) {
  const glm::vec3 up = std::fabs(to_light.y) > 0.99f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  return glm::lookAt(glm::vec3(0.0f), -to_light, up);
}

}  // namespace

const Light* shadow_caster(const Scene& scene) {
  const auto caster = std::find_if(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
    return light.kind == LightKind::directional && light.casts_shadow;
  });
  return caster == scene.lights.end() ? nullptr : &*caster;
}

glm::mat4 shadow_clip_from_world(const Scene& scene, const glm::vec3& to_light) {
  const SceneStats s = stats(scene);
  const glm::mat4 view = turned_to(to_light);
  glm::vec3 low(1e30f), high(-1e30f);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p((corner & 1) != 0 ? s.bounds_max.x : s.bounds_min.x,
                      (corner & 2) != 0 ? s.bounds_max.y : s.bounds_min.y,
                      (corner & 4) != 0 ? s.bounds_max.z : s.bounds_min.z);
    const glm::vec3 v(view * glm::vec4(p, 1.0f));
    low = glm::min(low, v);
    high = glm::max(high, v);
  }
  // Shares of the scene's size, not meters: a scene in other units has the same texels. A flat one, seen
  // along itself, needs a view as well.
  const glm::vec3 sides = high - low;
  const float longest = std::max({sides.x, sides.y, sides.z});
  const glm::vec3 margin = glm::max(0.01f * sides, glm::vec3(longest > 0.0f ? 1e-4f * longest : 1.0f));
  low -= margin;
  high += margin;
  return glm::ortho(low.x, high.x, low.y, high.y, -high.z, -low.z) * view;
}

glm::vec2 shadow_texels_per_m(const glm::mat4& shadow_clip_from_world, int map_px) {
  const glm::mat4& m = shadow_clip_from_world;
  const float half = 0.5f * static_cast<float>(map_px);
  const auto along = [&](int row) { return glm::length(glm::vec3(m[0][row], m[1][row], m[2][row])) * half; };
  return {along(0), along(1)};
}

}  // namespace hwsim::pipeline
