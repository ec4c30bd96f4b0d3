#include "pipeline/shade/lighting.h"

#include <algorithm>
#include <cmath>

#include "pipeline/scene/special_surfaces.h"

namespace hwsim::pipeline {
namespace {

PointLight make_point(const Light& light) {
  PointLight point;
  point.position = light.position;
  point.color = light.color;
  // Without a limit: to where the light falls to 1/1000 of its brightest channel at one meter.
  const float brightest = std::max({light.color.x, light.color.y, light.color.z, 1e-6f});
  const float range = light.range_m > 0.0f ? light.range_m : std::sqrt(brightest * 1000.0f);
  point.inv_range2 = 1.0f / (range * range);
  if (light.kind == LightKind::spot) {
    point.axis = light.direction;
    point.cos_outer = std::cos(light.outer_cone_rad);
    point.inv_cos_span = 1.0f / std::max(std::cos(light.inner_cone_rad) - point.cos_outer, 1e-3f);
  }
  return point;
}

}  // namespace

bool needs_extended_shading(const Scene& scene) {
  return has_unlit(scene) || has_metal_in_ambient_light(scene);
}

LightingUniforms make_lighting(const Scene& scene, const Camera& camera) {
  LightingUniforms u;
  u.eye = glm::vec3(glm::inverse(camera.view_from_world)[3]);
  u.ambient = scene.ambient;
  u.extended = needs_extended_shading(scene);
  u.directional.clear();
  u.points.clear();
  for (const Light& light : scene.lights) {
    if (light.kind == LightKind::directional)
      u.directional.push_back({-glm::normalize(light.direction), light.color, light.casts_shadow});
    else
      u.points.push_back(make_point(light));
  }
  u.directional_count = static_cast<int>(u.directional.size());
  u.point_count = static_cast<int>(u.points.size());
  if (u.directional.empty()) u.directional.resize(1);
  if (u.points.empty()) u.points.resize(1);
  return u;
}

}  // namespace hwsim::pipeline
