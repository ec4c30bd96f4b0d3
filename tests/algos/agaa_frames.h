#pragma once
// Small scenes for AGAA, and its images plane by plane.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "algos/frame_run.h"
#include "support/frames.h"

namespace hwsim::test {

inline constexpr int kWidth = 48, kHeight = 32;

/// Rectangles that face a camera at z = 2 which looks along -z; one material each.
struct Rectangle {
  float left, right, z;
  glm::vec3 color{0.5f};
  float slope = 0.0f;  ///< dz/dx; z is that of the left edge
  float alpha = 1.0f;
};

inline pipeline::Scene patches(const std::vector<Rectangle>& list) {
  pipeline::Scene scene;
  scene.name = "patches";
  scene.materials.clear();
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Rectangle& p = list[i];
    pipeline::Mesh mesh;
    const float z0 = p.z, z1 = p.z + p.slope * (p.right - p.left);
    mesh.positions = {{p.left, -5, z0}, {p.right, -5, z1}, {p.right, 5, z1}, {p.left, 5, z0}};
    mesh.normals.assign(4, glm::normalize(glm::vec3(-p.slope, 0, 1)));
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.parts = {{0, 6, static_cast<int>(i)}};
    mesh.vertex_bytes = 24;
    mesh.bounds_min = glm::vec3(p.left, -5, std::min(z0, z1));
    mesh.bounds_max = glm::vec3(p.right, 5, std::max(z0, z1));
    scene.meshes.push_back(mesh);
    scene.instances.push_back({static_cast<int>(i), glm::mat4(1.0f), "patch"});
    pipeline::Material material;
    material.base_color = glm::vec4(p.color, p.alpha);
    if (p.alpha < 1.0f) material.alpha_mode = pipeline::AlphaMode::mask;
    material.metallic = 0.0f;
    material.roughness = 0.5f;
    scene.materials.push_back(material);
  }
  scene.samplers.emplace_back();
  pipeline::Light light;
  light.kind = pipeline::LightKind::directional;
  light.direction = glm::normalize(glm::vec3(-0.3f, -0.4f, -1.0f));
  light.color = glm::vec3(0.8f);
  light.casts_shadow = false;
  scene.lights = {light};
  pipeline::Camera camera;
  camera.view_from_world = glm::mat4(1.0f);
  camera.view_from_world[3] = glm::vec4(0, 0, -2, 1);
  scene.cameras = {camera};
  return scene;
}

/// Half as wide as pixels, of two slopes in turn.
inline pipeline::Scene slats(float slope) {
  std::vector<Rectangle> list;
  const float half_pixel = 0.03625f;
  for (int i = -20; i < 20; ++i)
    list.push_back({half_pixel * static_cast<float>(i), half_pixel * static_cast<float>(i + 1), 0,
                    glm::vec3(0.5f), (i & 1) != 0 ? slope : -slope});
  return patches(list);
}

struct Shot {
  std::shared_ptr<const pipeline::Scene> scene;
  std::string technique;
  GpuFeatures features = test_features();
  int width = kWidth, height = kHeight;
  int shadow_map_px = 0;  ///< 0: no shadows
};

inline pipeline::FrameGraph build(const Shot& run) {
  algos::FrameRequest request;
  request.scene = run.scene;
  request.width_px = run.width;
  request.height_px = run.height;
  request.features = run.features;
  request.shadows = run.shadow_map_px > 0;
  request.shadow_map_px = std::max(run.shadow_map_px, 16);
  return algos::build_frame(algos::parse_technique(run.technique), request);
}

inline pipeline::Emulation emulate(const pipeline::FrameGraph& graph, const Shot& run) {
  return pipeline::emulate(graph, run.features, FunctionalConfig{}, {});
}
inline pipeline::Emulation render(const Shot& run) { return emulate(build(run), run); }

inline pipeline::ImageId image_named(const pipeline::FrameGraph& graph, const std::string& name) {
  for (std::size_t i = 0; i < graph.images().size(); ++i)
    if (graph.images()[i].name == name) return {static_cast<int>(i)};
  ADD_FAILURE() << "no image " << name;
  return {};
}

/// All channels of an image's plane: column x * planes + p of the result is plane p of pixel x.
inline const pipeline::FragmentProgram& unfold_all_program() {
  static const pipeline::FragmentProgram program =
      make_program("unfold_all", [](pipeline::FragmentBatch& batch, const void*) {
        const pipeline::GpuImage& image = *batch.resources->images[0];
        const int planes = image.samples * image.layers;
        for_each_lane(batch, [&](std::size_t lane) {
          float texel[4] = {};
          const int x = batch.pixel_x[lane] / planes, y = batch.pixel_y[lane];
          if (x < image.width && y < image.height)
            pipeline::read_texel(image, x, y, batch.pixel_x[lane] % planes, texel);
          for (int c = 0; c < 4; ++c) batch.color[0][c][lane] = texel[c];
        });
      });
  return program;
}

struct Planes {
  pipeline::Image image;
  int count = 1;
  const glm::vec4& at(int x, int y, int plane) const { return image.at(x * count + plane, y); }
};

inline Planes planes_of(const Shot& run, const std::string& name) {
  pipeline::FrameGraph graph = build(run);
  const pipeline::ImageId source = image_named(graph, name);
  Planes planes;
  planes.count = graph.image(source).samples * graph.image(source).layers;
  const pipeline::ImageId out =
      graph.add_image({"planes", Format::rgba32_float, run.width * planes.count, run.height, 1});
  pipeline::Pass& pass = graph.add_pass("unfold", PassKind::full_screen);
  pass.width = run.width * planes.count;
  pass.sampled = {source};
  pass.color = {out};
  pass.fragment = &unfold_all_program();
  pass.uniforms = std::make_shared<int>(0);
  graph.set_output(out);
  planes.image = emulate(graph, run).color;
  return planes;
}

inline float largest_difference(const pipeline::Image& a, const pipeline::Image& b) {
  float most = 0.0f;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) most = std::max(most, std::fabs(a.pixels[i][c] - b.pixels[i][c]));
  return most;
}

inline GpuFeatures native_features() {
  GpuFeatures features = test_features();
  features.native_msaa_max = 32;
  return features;
}

}  // namespace hwsim::test
