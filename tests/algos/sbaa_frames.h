#pragma once
// What the passes of SBAA hand to each other, sample by sample, and the scenes to look at it with.
#include <cmath>
#include <string>
#include <vector>

#include "algos/frame_run.h"
#include "support/frames.h"

namespace hwsim::test {

inline GpuFeatures features_for(int samples) {
  GpuFeatures features;
  features.native_msaa_max = samples > 8 ? samples : 8;
  return features;
}

inline pipeline::FrameGraph build_graph(const std::string& technique,
                                        std::shared_ptr<const pipeline::Scene> scene, int width, int height,
                                        bool shadows = false) {
  algos::FrameRequest request;
  request.scene = std::move(scene);
  request.width_px = width;
  request.height_px = height;
  request.shadows = shadows;
  request.shadow_map_px = 256;
  request.features = features_for(32);
  return algos::build_frame(algos::parse_technique(technique), request);
}

inline pipeline::Emulation run_graph(const pipeline::FrameGraph& graph) {
  pipeline::EmulationOptions options;
  options.jobs = 2;
  return pipeline::emulate(graph, features_for(32), FunctionalConfig{}, options);
}

inline pipeline::ImageId image_named(const pipeline::FrameGraph& graph, const std::string& name) {
  for (int i = 0; i < static_cast<int>(graph.images().size()); ++i)
    if (graph.images()[static_cast<std::size_t>(i)].name == name) return {i};
  return {};
}

/// All channels of image slot 0, its samples side by side. Uniforms: int, the samples.
inline const pipeline::FragmentProgram& dump_program() {
  static const pipeline::FragmentProgram program =
      make_program("dump", [](pipeline::FragmentBatch& batch, const void* u) {
        const int samples = *static_cast<const int*>(u);
        for_each_lane(batch, [&](std::size_t lane) {
          float texel[4] = {};
          const pipeline::GpuImage& image = *batch.resources->images[0];
          const int x = batch.pixel_x[lane] / samples, y = batch.pixel_y[lane];
          if (x < image.width && y < image.height)
            pipeline::read_texel(image, x, y, batch.pixel_x[lane] % samples, texel);
          for (int c = 0; c < 4; ++c) batch.color[0][c][lane] = texel[c];
        });
      });
  return program;
}

/// An image of the frame's as its passes leave it: column x * samples + s is sample s of pixel x.
inline pipeline::Image dump(pipeline::FrameGraph graph, const std::string& name) {
  using namespace pipeline;
  const ImageId id = image_named(graph, name);
  const ImageDesc from = graph.image(id);
  const ImageId out =
      graph.add_image({"dump", Format::rgba32_float, from.width * from.samples, from.height, 1});
  Pass& pass = graph.add_pass("dump", PassKind::full_screen);
  pass.width = from.width * from.samples;
  pass.height = from.height;
  pass.color = {out};
  pass.sampled = {id};
  pass.fragment = &dump_program();
  pass.uniforms = std::make_shared<int>(from.samples);
  graph.set_output(out);
  return run_graph(graph).color;
}

/// A scene of one mesh seen from the origin along -z; every triangle has the normal of its plane.
inline pipeline::Scene faceted_scene(const std::vector<glm::vec3>& corners) {
  std::vector<std::uint32_t> indices(corners.size());
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<std::uint32_t>(i);
  pipeline::Scene scene = clip_space_scene(corners, std::move(indices));
  pipeline::Mesh& mesh = scene.meshes.front();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::size_t t = i / 3 * 3;
    mesh.normals[i] = glm::normalize(glm::cross(corners[t + 1] - corners[t], corners[t + 2] - corners[t]));
  }
  scene.materials.front().metallic = 0.0f;
  scene.materials.front().roughness = 0.6f;
  scene.materials.front().double_sided = true;
  scene.lights.front().direction = glm::normalize(glm::vec3(0.3f, -0.4f, -1.0f));
  scene.cameras.front().near_m = 1.0f;
  scene.cameras.front().far_m = 100.0f;
  return scene;
}

/// The parallelogram origin + [0,1] u + [0,1] v, in steps x steps x 2 triangles.
inline void add_grid(std::vector<glm::vec3>& corners, glm::vec3 origin, glm::vec3 u, glm::vec3 v, int steps) {
  const auto at = [&](int i, int j) {
    return origin + u * (static_cast<float>(i) / static_cast<float>(steps)) +
           v * (static_cast<float>(j) / static_cast<float>(steps));
  };
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < steps; ++i)
      for (const glm::ivec2 c : {glm::ivec2(0, 0), {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
        corners.push_back(at(i + c.x, j + c.y));
}

inline double encode_srgb_code(double linear) {
  const double c = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
  return 255.0 * c;
}

/// Largest difference of two pixels' channels in 8-bit codes.
inline double code_difference(const glm::vec4& a, const glm::vec4& b) {
  double most = 0.0;
  for (int c = 0; c < 3; ++c)
    most = std::max(most, std::fabs(encode_srgb_code(a[c]) - encode_srgb_code(b[c])));
  return most;
}

}  // namespace hwsim::test
