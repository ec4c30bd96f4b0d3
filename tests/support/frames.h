#pragma once
// Scenes, shaders and graphs that tests build by hand.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "hwsim/gpu/every_feature.h"
#include "pipeline/batch/fragment_batch.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/shade/mesh_vertex.h"

namespace hwsim::test {

/// One mesh whose positions are clip coordinates (w = 1) under the identity matrix.
inline pipeline::Scene clip_space_scene(std::vector<glm::vec3> positions,
                                        std::vector<std::uint32_t> indices) {
  using namespace pipeline;
  Scene scene;
  scene.name = "test";
  Mesh mesh;
  mesh.positions = std::move(positions);
  mesh.normals.assign(mesh.positions.size(), glm::vec3(0, 0, 1));
  mesh.indices = std::move(indices);
  mesh.parts = {{0, static_cast<std::uint32_t>(mesh.indices.size()), 0}};
  mesh.vertex_bytes = 24;
  mesh.bounds_min = mesh.bounds_max = mesh.positions.empty() ? glm::vec3(0.0f) : mesh.positions.front();
  for (const glm::vec3& p : mesh.positions) {
    mesh.bounds_min = glm::min(mesh.bounds_min, p);
    mesh.bounds_max = glm::max(mesh.bounds_max, p);
  }
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({0, glm::mat4(1.0f), "instance"});
  scene.materials.emplace_back();
  scene.samplers.emplace_back();
  scene.lights.emplace_back();
  scene.cameras.emplace_back();
  return scene;
}

inline std::shared_ptr<const pipeline::Scene> share(pipeline::Scene scene) {
  return std::make_shared<const pipeline::Scene>(std::move(scene));
}

template <class Body>
void for_each_lane(pipeline::FragmentBatch& batch, Body&& body) {
  for (std::size_t lane = 0; lane < static_cast<std::size_t>(4 * batch.quad_count); ++lane) body(lane);
}

inline pipeline::FragmentProgram make_program(std::string name,
                                              void (*run)(pipeline::FragmentBatch&, const void*)) {
  pipeline::FragmentProgram program;
  program.name = std::move(name);
  program.run = run;
  return program;
}

/// A constant; uniforms: glm::vec4.
inline const pipeline::FragmentProgram& constant_program(int varyings = 0) {
  static const std::vector<pipeline::FragmentProgram> programs = [] {
    std::vector<pipeline::FragmentProgram> all;
    for (int i = 0; i <= pipeline::VertexBatch::kMaxVaryings; ++i) {
      all.push_back(make_program("constant", [](pipeline::FragmentBatch& batch, const void* u) {
        const glm::vec4& color = *static_cast<const glm::vec4*>(u);
        for_each_lane(batch, [&](std::size_t lane) {
          for (int c = 0; c < 4; ++c) batch.color[0][c][lane] = color[c];
        });
      }));
      all.back().varying_scalars = i;
    }
    return all;
  }();
  return programs[static_cast<std::size_t>(varyings)];
}

/// The number of the triangle in the pass, counted from 1.
inline const pipeline::FragmentProgram& primitive_program() {
  static const pipeline::FragmentProgram program =
      make_program("primitive", [](pipeline::FragmentBatch& batch, const void*) {
        for_each_lane(batch, [&](std::size_t lane) {
          for (int c = 0; c < 4; ++c) batch.color[0][c][lane] = 0.0f;
          batch.color[0][0][lane] = static_cast<float>(batch.primitive[lane / 4] + 1);
        });
      });
  return program;
}

/// Full-screen over an image `samples` times as wide: column x shows sample x % samples of pixel x / samples.
/// Red from image slot 0, green from slot 1 if there is one; of images with fewer samples, the one that
/// stands for sample s. Uniforms: int, the samples.
inline const pipeline::FragmentProgram& unfold_program() {
  static const pipeline::FragmentProgram program =
      make_program("unfold", [](pipeline::FragmentBatch& batch, const void* u) {
        const int samples = *static_cast<const int*>(u);
        for_each_lane(batch, [&](std::size_t lane) {
          for (int c = 0; c < 4; ++c) batch.color[0][c][lane] = 0.0f;
          const int x = batch.pixel_x[lane] / samples, s = batch.pixel_x[lane] % samples,
                    y = batch.pixel_y[lane];
          for (std::size_t slot = 0; slot < 2; ++slot) {
            const pipeline::GpuImage* image = batch.resources->images[slot];
            if (image == nullptr || x >= image->width || y >= image->height) continue;
            float texel[4];
            pipeline::read_texel(*image, x, y, s * image->samples * image->layers / samples, texel);
            batch.color[0][slot][lane] = texel[0];
          }
        });
      });
  return program;
}

/// A frame with one color and one depth image, cleared first; add draws, then `run` for all samples' red and
/// depth.
class SampleFrame {
 public:
  SampleFrame(std::shared_ptr<const pipeline::Scene> scene, int width, int height, int samples,
              Format color = Format::r32_float, Format depth = Format::d32_float, int color_samples = 0,
              std::vector<pipeline::ViewportShift> viewports = {})
      : graph(std::move(scene), width, height), samples_(samples), viewports_(std::move(viewports)) {
    color_ = graph.add_image(
        {"color", color, width, height, color_samples == 0 ? samples : color_samples, layers()});
    depth_ = graph.add_image({"depth", depth, width, height, samples, layers()});
    graph.add_clear("clear", {color_, depth_});
  }

  /// All of the scene's meshes.
  pipeline::DrawBatch all_draws(const pipeline::VertexProgram& vertex,
                                const pipeline::FragmentProgram* fragment,
                                const glm::mat4& clip_from_world = glm::mat4(1.0f)) const {
    pipeline::DrawBatch batch;
    batch.vertex = &vertex;
    batch.vertex_uniforms =
        std::make_shared<pipeline::MeshVertexUniforms>(pipeline::MeshVertexUniforms{clip_from_world});
    batch.fragment = fragment;
    batch.fragment_uniforms = std::make_shared<glm::vec4>(1.0f);
    batch.state.raster.cull = pipeline::CullMode::none;
    const pipeline::Scene& scene = graph.scene();
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
      for (std::size_t p = 0;
           p < scene.meshes[static_cast<std::size_t>(scene.instances[i].mesh)].parts.size(); ++p)
        batch.draws.push_back({static_cast<int>(i), static_cast<int>(p)});
    return batch;
  }

  pipeline::Pass& draw(const std::string& name, std::vector<pipeline::DrawBatch> batches,
                       bool with_color = true) {
    pipeline::Pass& pass = graph.add_pass(name, PassKind::draw);
    pass.samples = samples_;
    pass.viewports = viewports_;
    if (with_color) pass.color = {color_};
    pass.depth = depth_;
    pass.batches = std::move(batches);
    return pass;
  }

  /// Column x * samples + s of the image holds sample s: red the color's red, green the depth.
  pipeline::Emulation run(const pipeline::EmulationOptions& options = {}) {
    const int planes = samples_ * layers();
    const pipeline::ImageId out =
        graph.add_image({"samples", Format::rgba32_float, graph.width() * planes, graph.height(), 1});
    pipeline::Pass& pass = graph.add_pass("unfold", PassKind::full_screen);
    pass.width = graph.width() * planes;
    pass.color = {out};
    pass.sampled = {color_, depth_};
    pass.fragment = &unfold_program();
    pass.uniforms = std::make_shared<int>(planes);
    graph.set_output(out);
    return pipeline::emulate(graph, every_feature(32), FunctionalConfig{}, options);
  }

  pipeline::ImageId color() const { return color_; }
  pipeline::ImageId depth() const { return depth_; }
  pipeline::FrameGraph graph;

 private:
  int layers() const { return viewports_.empty() ? 1 : static_cast<int>(viewports_.size()); }

  int samples_;
  std::vector<pipeline::ViewportShift> viewports_;
  pipeline::ImageId color_, depth_;
};

inline const PassWork& pass_named(const WorkTrace& trace, const std::string& name) {
  return *std::find_if(trace.passes.begin(), trace.passes.end(),
                       [&](const PassWork& p) { return p.name == name; });
}

}  // namespace hwsim::test
