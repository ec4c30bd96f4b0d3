#pragma once
// Rods with thin highlights, as selective supersampling is tested on.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <string>

#include "algos/frame_run.h"
#include "support/frames.h"

namespace hwsim::test::sss {
using namespace pipeline;

/// Size of a frame, px.
constexpr int kSssWidth = 96, kSssHeight = 64;

/// A cylinder along x with smooth normals; the eye looks at it along -z.
inline void add_cylinder(Mesh& mesh, float y, float radius, int around, int along, float tilt = 0.0f) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int i = 0; i <= along; ++i)
    for (int j = 0; j <= around; ++j) {
      const float a = 6.2831853f * static_cast<float>(j) / static_cast<float>(around);
      const float x = -3.0f + 6.0f * static_cast<float>(i) / static_cast<float>(along);
      mesh.positions.push_back({x, y + tilt * x + radius * std::sin(a), radius * std::cos(a)});
      mesh.normals.push_back({0.0f, std::sin(a), std::cos(a)});
    }
  const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(i * (around + 1) + j); };
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < around; ++j)
      mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j),
                                               at(i + 1, j + 1), at(i, j + 1)});
}

inline Scene empty_scene() {
  Scene scene;
  scene.name = "strip";
  scene.materials.emplace_back();
  scene.materials[0].base_color = {0.6f, 0.5f, 0.4f, 1.0f};
  scene.materials[0].metallic = 1.0f;
  scene.materials[0].roughness = 0.35f;
  scene.samplers.emplace_back();
  Light sun;
  sun.direction = glm::normalize(glm::vec3(0.0f, -0.7f, -0.7f));
  scene.lights = {sun};
  Camera camera;
  camera.view_from_world = glm::lookAt(glm::vec3(0, 0, 6), glm::vec3(0.0f), glm::vec3(0, 1, 0));
  camera.fov_y_rad = 0.5f;
  camera.near_m = 1.0f;
  camera.far_m = 20.0f;
  scene.cameras = {camera};
  scene.background = glm::vec3(0.0f);
  return scene;
}

inline std::shared_ptr<const Scene> finish(Scene scene, Mesh mesh) {
  mesh.parts = {{0, static_cast<std::uint32_t>(mesh.indices.size()), 0}};
  mesh.vertex_bytes = 24;
  mesh.bounds_min = glm::vec3(1e9f);
  mesh.bounds_max = glm::vec3(-1e9f);
  for (const glm::vec3& p : mesh.positions) {
    mesh.bounds_min = glm::min(mesh.bounds_min, p);
    mesh.bounds_max = glm::max(mesh.bounds_max, p);
  }
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, glm::mat4(1.0f), "mesh"});
  return std::make_shared<const Scene>(std::move(scene));
}

/// A few thin rods, slightly tilted.
inline std::shared_ptr<const Scene> rods() {
  Mesh mesh;
  for (int i = 0; i < 5; ++i)
    add_cylinder(mesh, -1.0f + 0.5f * static_cast<float>(i), 0.02f + 0.02f * static_cast<float>(i), 10, 60,
                 0.02f);
  return finish(empty_scene(), std::move(mesh));
}

inline FrameGraph graph_of(const std::shared_ptr<const Scene>& scene, const std::string& technique,
                           int width = kSssWidth, int height = kSssHeight) {
  algos::FrameRequest request;
  request.scene = scene;
  request.width_px = width;
  request.height_px = height;
  request.shadows = false;
  request.features.conservative_raster = true;
  return algos::build_frame(algos::parse_technique(technique), request);
}
inline Emulation run(const std::shared_ptr<const Scene>& scene, const std::string& technique,
                     int width = kSssWidth, int height = kSssHeight) {
  GpuFeatures features;
  features.conservative_raster = true;
  return emulate(graph_of(scene, technique, width, height), features, FunctionalConfig{}, {});
}
inline TechniqueCounters counters(const Emulation& e) { return total(e.trace).technique; }

inline float largest_difference(const Image& a, const Image& b) {
  float most = 0.0f;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(a.pixels[i][c] - b.pixels[i][c]));
  return most;
}

/// A rod that gives off light and reflects none, before black: every sample has its color, so that an image's
/// light is the area that it is shown with.
inline Scene shining_scene() {
  Scene scene = empty_scene();
  scene.materials[0].base_color = {0, 0, 0, 1};
  scene.materials[0].metallic = 0.0f;
  scene.materials[0].emissive = glm::vec3(1.0f);
  scene.lights[0].color = scene.ambient = scene.background = glm::vec3(0.0f);
  return scene;
}

}  // namespace hwsim::test::sss
