#include "pipeline/reference/interpolate.h"

#include <cmath>

namespace hwsim::pipeline {
namespace {

glm::vec3 unit(glm::vec3 v, glm::vec3 otherwise) {
  const float squared = glm::dot(v, v);
  return squared > 0.0f ? v / std::sqrt(squared) : otherwise;
}

glm::vec3 transformed(const glm::mat4& matrix, glm::vec3 point) {
  return glm::vec3(matrix * glm::vec4(point, 1.0f));
}

// The triangle's plane in world space.
struct WorldTriangle {
  glm::vec3 origin, edge_u, edge_v, normal;  // the normal is not of unit length

  WorldTriangle(const Mesh& mesh, const TriangleWeights& t, const glm::mat4& world_from_local)
      : origin(transformed(world_from_local, mesh.positions[t.vertices[0]])),
        edge_u(transformed(world_from_local, mesh.positions[t.vertices[1]]) - origin),
        edge_v(transformed(world_from_local, mesh.positions[t.vertices[2]]) - origin),
        normal(glm::cross(edge_u, edge_v)) {}

  // How u and v change along a step in the plane.
  glm::vec2 weights_of(glm::vec3 step) const {
    const float squared = glm::dot(normal, normal);
    if (!(squared > 0.0f)) return glm::vec2(0.0f);
    return {glm::dot(glm::cross(step, edge_v), normal) / squared,
            glm::dot(glm::cross(edge_u, step), normal) / squared};
  }
};

// How far the point of intersection moves while origin and direction of the ray change.
glm::vec3 plane_step(const WorldTriangle& triangle, const Ray& ray, float t, glm::vec3 origin_step,
                     glm::vec3 direction_step) {
  const float along = glm::dot(triangle.normal, ray.direction);
  const glm::vec3 moved = origin_step + t * direction_step;
  return along != 0.0f ? moved - glm::dot(triangle.normal, moved) / along * ray.direction : moved;
}

glm::vec2 attribute_step(const std::vector<glm::vec2>& uv, const TriangleWeights& t, glm::vec2 weights) {
  if (uv.empty()) return glm::vec2(0.0f);
  const glm::vec2 first = uv[t.vertices[0]];
  return (uv[t.vertices[1]] - first) * weights.x + (uv[t.vertices[2]] - first) * weights.y;
}

}  // namespace

TriangleWeights triangle_weights(const Mesh& mesh, std::uint32_t primitive, float u, float v) {
  const std::size_t first = std::size_t{primitive} * 3;
  return {{mesh.indices[first], mesh.indices[first + 1], mesh.indices[first + 2]}, {1.0f - u - v, u, v}};
}

SurfaceHit interpolate_surface(const Scene& scene, const Visibility& hit, const PixelRay& pixel,
                               const glm::mat3& world_normal_from_local) {
  const Instance& instance = scene.instances[hit.instance];
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
  const TriangleWeights t = triangle_weights(mesh, hit.primitive, hit.u, hit.v);
  const WorldTriangle triangle(mesh, t, instance.world_from_local);
  SurfaceHit s;
  s.position = transformed(instance.world_from_local, interpolate(mesh.positions, t, glm::vec3(0.0f)));
  s.to_viewer = unit(-pixel.ray.direction, glm::vec3(0.0f, 0.0f, 1.0f));
  s.geometric_normal = unit(triangle.normal, s.to_viewer);
  if (glm::dot(s.geometric_normal, s.to_viewer) < 0.0f) s.geometric_normal = -s.geometric_normal;
  s.normal =
      unit(world_normal_from_local * interpolate(mesh.normals, t, glm::vec3(0.0f)), s.geometric_normal);
  if (!hit.front_face) s.normal = -s.normal;
  const glm::vec4 tangent = interpolate(mesh.tangents, t, glm::vec4(0.0f));
  s.tangent = glm::vec4(unit(glm::mat3(instance.world_from_local) * glm::vec3(tangent), glm::vec3(0.0f)),
                        mesh.tangents.empty() ? 0.0f : mesh.tangents[t.vertices[0]].w);
  s.uv0 = interpolate(mesh.uv0, t, glm::vec2(0.0f));
  s.uv1 = interpolate(mesh.uv1, t, glm::vec2(0.0f));
  s.color = interpolate(mesh.colors, t, glm::vec4(1.0f));
  const glm::vec2 dx =
      triangle.weights_of(plane_step(triangle, pixel.ray, hit.t, pixel.origin_dx, pixel.direction_dx));
  const glm::vec2 dy =
      triangle.weights_of(plane_step(triangle, pixel.ray, hit.t, pixel.origin_dy, pixel.direction_dy));
  s.uv0_dx = attribute_step(mesh.uv0, t, dx);
  s.uv0_dy = attribute_step(mesh.uv0, t, dy);
  s.uv1_dx = attribute_step(mesh.uv1, t, dx);
  s.uv1_dy = attribute_step(mesh.uv1, t, dy);
  s.view_distance_m = hit.t;
  s.material = mesh.parts[hit.part].material;
  s.instance = hit.instance;
  s.primitive = hit.primitive;
  s.front_face = hit.front_face;
  return s;
}

}  // namespace hwsim::pipeline
