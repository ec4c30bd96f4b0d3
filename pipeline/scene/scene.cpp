#include "pipeline/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "pipeline/scene/framing.h"

namespace hwsim::pipeline {
namespace {

glm::vec3 box_corner(const glm::vec3& low, const glm::vec3& high, int i) {
  return {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
}

// The distance of the box's farthest corner, along the view.
float farthest_m(const Camera& camera, const glm::vec3& low, const glm::vec3& high) {
  float farthest = 0.0f;
  for (int i = 0; i < 8; ++i)
    farthest = std::max(farthest, -(camera.view_from_world * glm::vec4(box_corner(low, high, i), 1.0f)).z);
  return farthest;
}

void add_instance(SceneStats& out, const Scene& scene, const Mesh& mesh) {
  for (const Mesh::Part& part : mesh.parts) {
    const std::uint64_t triangles = part.index_count / 3;
    out.drawn_triangles += triangles;
    const AlphaMode mode = scene.materials[static_cast<std::size_t>(part.material)].alpha_mode;
    if (mode == AlphaMode::mask) out.drawn_mask_triangles += triangles;
    if (mode == AlphaMode::blend) out.drawn_blend_triangles += triangles;
  }
}

}  // namespace

glm::mat4 clip_from_view(const Camera& camera, float aspect_ratio) {
  const float near = camera.near_m, far = camera.far_m;
  const float half_height =
      (camera.orthographic ? camera.ortho_half_height_m : std::tan(camera.fov_y_rad * 0.5f)) *
      static_cast<float>(frame_widening(camera, aspect_ratio));
  glm::mat4 m(0.0f);
  m[0][0] = 1.0f / (half_height * aspect_ratio);
  m[1][1] = 1.0f / half_height;
  if (camera.orthographic) {
    m[2][2] = -1.0f / (far - near);
    m[3][2] = -near / (far - near);
    m[3][3] = 1.0f;
  } else {
    m[2][2] = -far / (far - near);
    m[3][2] = -far * near / (far - near);
    m[2][3] = -1.0f;
  }
  return m;
}

SceneStats stats(const Scene& scene) {
  SceneStats out;
  for (const Mesh& mesh : scene.meshes) {
    out.stored_triangles += mesh.indices.size() / 3;
    out.vertices += mesh.positions.size();
  }
  for (std::size_t i = 0; i < scene.textures.size(); ++i)
    for (const MipLevel& level : levels_of(scene, i))
      out.texture_bytes += level.texels.size() * sizeof(std::uint32_t);
  bool first = true;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    add_instance(out, scene, mesh);
    if (mesh.parts.empty()) continue;
    for (int i = 0; i < 8; ++i) {
      const glm::vec3 corner = glm::vec3(instance.world_from_local *
                                         glm::vec4(box_corner(mesh.bounds_min, mesh.bounds_max, i), 1.0f));
      out.bounds_min = first ? corner : glm::min(out.bounds_min, corner);
      out.bounds_max = first ? corner : glm::max(out.bounds_max, corner);
      first = false;
    }
  }
  return out;
}

double frame_widening(const Camera& camera, double aspect_ratio) {
  // A thousandth is rounding: exporters write 1.7777.
  const double excess = static_cast<double>(camera.aspect_ratio) / aspect_ratio;
  return excess > 1.001 ? excess : 1.0;
}

double half_height(const Camera& camera, double aspect_ratio) {
  const double own = camera.orthographic ? static_cast<double>(camera.ortho_half_height_m)
                                         : std::tan(static_cast<double>(camera.fov_y_rad) / 2);
  return own * frame_widening(camera, aspect_ratio);
}

const std::vector<MipLevel>& levels_of(const Scene& scene, std::size_t texture) {
  const Texture& own = scene.textures[texture];
  return own.same_texels_as < 0 ? own.levels
                                : scene.textures[static_cast<std::size_t>(own.same_texels_as)].levels;
}

Camera framing_camera(const glm::vec3& bounds_min, const glm::vec3& bounds_max) {
  Camera camera;
  camera.name = "default";
  const glm::vec3 center = bounds_min * 0.5f + bounds_max * 0.5f;
  const float radius = std::max(0.5f * glm::length(bounds_max - bounds_min), 1e-6f);
  const float distance = 1.05f * radius / std::sin(camera.fov_y_rad * 0.5f);
  const glm::vec3 toward_eye = glm::normalize(glm::vec3(0.45f, 0.35f, 1.0f));
  camera.view_from_world = glm::lookAtRH(center + toward_eye * distance, center, glm::vec3(0, 1, 0));
  camera.near_m = (distance - radius) * 0.5f;
  camera.far_m = distance + 1.5f * radius;
  return camera;
}

float far_plane_m(const Camera& camera, const glm::vec3& bounds_min, const glm::vec3& bounds_max) {
  return std::max(10.0f * camera.near_m, 1.01f * farthest_m(camera, bounds_min, bounds_max));
}

bool depths_run_together(const Camera& camera, const glm::vec3& bounds_min, const glm::vec3& bounds_max) {
  constexpr double kRounding = 0x1p-24, kOfTheScene = 0.1;
  if (camera.orthographic) return false;
  // Depth is 1 - near/z: a step of it is z^2/near.
  const auto z = static_cast<double>(std::min(farthest_m(camera, bounds_min, bounds_max), camera.far_m));
  const double step = kRounding * z * z / static_cast<double>(camera.near_m);
  const double size = glm::length(glm::dvec3(bounds_max) - glm::dvec3(bounds_min));
  return size > 0.0 && step > kOfTheScene * size;
}

Light default_sun() {
  Light sun;
  sun.name = "default sun";
  sun.direction = glm::normalize(glm::vec3(0.4f, -1.0f, -0.35f));
  sun.casts_shadow = true;
  return sun;
}

}  // namespace hwsim::pipeline
