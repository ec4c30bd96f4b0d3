#include "pipeline/gltf/exposure.h"

#include <algorithm>

namespace hwsim::pipeline::gltf {

double illuminance(std::span<const Light> lights, const Box& bounds) {
  double sum = 0.0;
  for (const Light& light : lights) {
    const double brightest = std::max({light.color.x, light.color.y, light.color.z});
    if (light.kind == LightKind::directional) {
      sum += brightest;
      continue;
    }
    const double distance =
        std::max(glm::length(glm::dvec3(light.position) - bounds.center()), bounds.diagonal() / 2);
    if (distance > 0.0) sum += brightest / (distance * distance);
  }
  return sum;
}

double automatic_exposure(std::span<const Light> lights, const Box& bounds) {
  constexpr double kMeantAsItIs = 20.0;
  const double light = illuminance(lights, bounds);
  return light > kMeantAsItIs ? 1.0 / light : 1.0;
}

}  // namespace hwsim::pipeline::gltf
