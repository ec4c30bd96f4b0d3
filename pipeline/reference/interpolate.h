#pragma once
// A surface at a point of a triangle: attributes and their derivatives.
#include <array>

#include "pipeline/reference/reference_scene.h"

namespace hwsim::pipeline {

struct TriangleWeights {
  std::array<std::size_t, 3> vertices;
  std::array<float, 3> weights;
};

TriangleWeights triangle_weights(const Mesh& mesh, std::uint32_t primitive, float u, float v);

/// `missing` where the mesh lacks the attribute.
template <class T>
T interpolate(const std::vector<T>& attribute, const TriangleWeights& t, const T& missing) {
  if (attribute.empty()) return missing;
  return attribute[t.vertices[0]] * t.weights[0] + attribute[t.vertices[1]] * t.weights[1] +
         attribute[t.vertices[2]] * t.weights[2];
}

/// Everything of SurfaceHit. Derivatives are those of the plane through the triangle (Igehy 1999).
SurfaceHit interpolate_surface(const Scene& scene, const Visibility& hit, const PixelRay& pixel,
                               const glm::mat3& world_normal_from_local);

}  // namespace hwsim::pipeline
