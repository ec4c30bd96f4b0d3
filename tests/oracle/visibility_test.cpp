// Rays of Embree through every sample position against the emulated rasterizer: both must see the same
// triangle, except where vertices rounded to 1/256 pixel move an edge over the sample.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

#include "oracle/id_program.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/open/scene_source.h"
#include "pipeline/reference/reference.h"
#include "pipeline/reference/reference_shading.h"
#include "pipeline/scene_glb.h"
#include "pipeline/shade/mesh_vertex.h"
#include "pipeline/state/sample_pattern.h"
#include "support/places.h"

namespace hwsim::oracle {
namespace {
using namespace pipeline;

constexpr int kWidth = 640, kHeight = 360, kSamples = 4;

struct Seen {
  int instance = -1;  ///< -1: the background
  std::uint32_t primitive = 0;
  friend bool operator==(const Seen&, const Seen&) = default;
};

/// Draws of a pass in order, and which triangle of which instance a number of the pass is.
class IdFrame {
 public:
  explicit IdFrame(std::shared_ptr<const Scene> scene) : scene_(std::move(scene)) {
    for (const AlphaMode mode : {AlphaMode::opaque, AlphaMode::mask}) add_draws(mode);
  }

  /// Samples of a pixel together, pixels row by row from the top.
  std::vector<Seen> emulate_samples() const {
    FrameGraph graph(scene_, kWidth * kSamples, kHeight);
    const ImageId ids = graph.add_image({"ids", Format::r32_float, kWidth, kHeight, kSamples});
    const ImageId depth = graph.add_image({"depth", Format::d32_float, kWidth, kHeight, kSamples});
    const ImageId output = graph.add_image({"spread", Format::r32_float, kWidth * kSamples, kHeight, 1});
    graph.set_output(output);
    graph.add_clear("clear", {ids, depth}, glm::vec4(-1.0f));
    Pass& draw = graph.add_pass("ids", PassKind::draw);
    draw.width = kWidth;
    draw.height = kHeight;
    draw.samples = kSamples;
    draw.color = {ids};
    draw.depth = depth;
    draw.batches = {batch(0), batch(1)};
    Pass& spread = graph.add_pass("spread", PassKind::full_screen);
    spread.sampled = {ids};
    spread.color = {output};
    spread.fragment = &spread_samples_program();
    spread.uniforms = std::make_shared<SampleSpread>(SampleSpread{kSamples});
    EmulationOptions options;
    options.jobs = 2;
    const Image image = emulate(graph, {}, {}, options).color;
    std::vector<Seen> seen;
    for (const glm::vec4& pixel : image.pixels) seen.push_back(seen_of(pixel.x));
    return seen;
  }

 private:
  void add_draws(AlphaMode mode) {
    for (std::size_t i = 0; i < scene_->instances.size(); ++i) {
      const Mesh& mesh = scene_->meshes[static_cast<std::size_t>(scene_->instances[i].mesh)];
      for (std::size_t p = 0; p < mesh.parts.size(); ++p) {
        if (scene_->materials[static_cast<std::size_t>(mesh.parts[p].material)].alpha_mode != mode) continue;
        draws_[mode == AlphaMode::mask].push_back({static_cast<int>(i), static_cast<int>(p)});
        first_of_draw_[triangles_] = {static_cast<int>(i), mesh.parts[p].first_index / 3};
        triangles_ += mesh.parts[p].index_count / 3;
      }
    }
  }

  DrawBatch batch(std::size_t alpha_test) const {
    const Camera& camera = scene_->cameras.front();
    const glm::mat4 clip =
        clip_from_view(camera, static_cast<float>(kWidth) / kHeight) * camera.view_from_world;
    DrawBatch batch;
    batch.state.depth = {true, true, Compare::less};
    batch.vertex = &mesh_uv_program();
    batch.vertex_uniforms = std::make_shared<MeshVertexUniforms>(MeshVertexUniforms{clip});
    batch.fragment = &id_program(alpha_test != 0);
    batch.state.raster.sample_rate = alpha_test != 0;  // rays test alpha where the sample is
    batch.draws = draws_[alpha_test];
    return batch;
  }

  Seen seen_of(float id) const {
    if (id < 0.0f) return {};
    const auto number = static_cast<std::uint32_t>(id);
    const auto& [first, seen] = *std::prev(first_of_draw_.upper_bound(number));
    return {seen.instance, seen.primitive + (number - first)};
  }

  std::shared_ptr<const Scene> scene_;
  std::array<std::vector<DrawCall>, 2> draws_;  // opaque, alpha-tested
  std::map<std::uint32_t, Seen> first_of_draw_;
  std::uint32_t triangles_ = 0;
};

/// A triangle on the screen, exact but for double rounding, also where vertices are behind the camera:
/// homogeneous pixel coordinates (x w, y w, w).
class Projected {
 public:
  Projected(const Scene& scene, const Seen& seen) {
    const Instance& instance = scene.instances[static_cast<std::size_t>(seen.instance)];
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    const Camera& camera = scene.cameras.front();
    const glm::dmat4 clip = glm::dmat4(clip_from_view(camera, static_cast<float>(kWidth) / kHeight)) *
                            glm::dmat4(camera.view_from_world) * glm::dmat4(instance.world_from_local);
    std::array<glm::dvec3, 3> v;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec4 p =
          clip * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[3 * seen.primitive + i]]), 1.0);
      v[i] = {(p.w + p.x) * kWidth / 2.0, (p.w - p.y) * kHeight / 2.0, p.w};
    }
    for (std::size_t i = 0; i < 3; ++i) edges_[i] = glm::cross(v[(i + 1) % 3], v[(i + 2) % 3]);
    determinant_ = glm::dot(v[0], edges_[0]);
    material_ = material_of(mesh, seen.primitive);
  }

  int material() const { return material_; }

  /// Pixels from the position to the nearest edge line, negative outside the triangle.
  double inside_px(glm::dvec2 at) const {
    double least = 1e30;
    for (const glm::dvec3& edge : edges_)
      least = std::min(least, glm::dot(edge, glm::dvec3(at, 1.0)) / glm::length(glm::dvec2(edge)));
    return determinant_ < 0.0 ? -greatest(at) : least;
  }

  /// Along the optical axis, of the triangle's plane at the position.
  double distance_m(glm::dvec2 at) const {
    double sum = 0.0;
    for (const glm::dvec3& edge : edges_) sum += glm::dot(edge, glm::dvec3(at, 1.0));
    return determinant_ / sum;
  }

 private:
  static int material_of(const Mesh& mesh, std::uint32_t primitive) {
    for (const Mesh::Part& part : mesh.parts)
      if (3 * primitive >= part.first_index && 3 * primitive < part.first_index + part.index_count)
        return part.material;
    return 0;
  }
  double greatest(glm::dvec2 at) const {
    double most = -1e30;
    for (const glm::dvec3& edge : edges_)
      most = std::max(most, glm::dot(edge, glm::dvec3(at, 1.0)) / glm::length(glm::dvec2(edge)));
    return most;
  }

  std::array<glm::dvec3, 3> edges_;
  double determinant_;
  int material_;
};

struct Census {
  std::uint64_t samples = 0, equal = 0, edge = 0, tie = 0, alpha = 0, other = 0;
  double agreement_pct() const { return 100.0 * static_cast<double>(equal) / static_cast<double>(samples); }
  double agreement_off_edges_pct() const {
    return 100.0 * static_cast<double>(equal) / static_cast<double>(samples - edge);
  }
};

class Classifier {
 public:
  explicit Classifier(const Scene& scene) : scene_(scene) {}

  void count(const Seen& emulated, const Seen& traced, glm::dvec2 at) {
    ++census.samples;
    if (emulated == traced) {
      ++census.equal;
      return;
    }
    std::vector<Projected> triangles;
    for (const Seen& seen : {emulated, traced})
      if (seen.instance >= 0) triangles.emplace_back(scene_, seen);
    ++cause_of(triangles, at);
    if (census.other > reported_ && reported_ < 5) report(emulated, traced, triangles, at);
  }

  Census census;

 private:
  // Vertices move by up to 1/512 px in x and y, so edges by less than 1/256 px; and by the rounding of
  // single-precision clip coordinates, some 1e-7 of the image's width.
  static constexpr double kEdgePx = 1.0 / 256 + 640 * 4e-7;
  // Relative. dragon_small.glb holds some triangles twice: rays and rasterizer keep different ones of a pair.
  static constexpr double kTie = 1e-4;

  std::uint64_t& cause_of(const std::vector<Projected>& triangles, glm::dvec2 at) {
    for (const Projected& triangle : triangles)
      if (std::fabs(triangle.inside_px(at)) <= kEdgePx) return census.edge;
    for (const Projected& triangle : triangles)
      if (scene_.materials[static_cast<std::size_t>(triangle.material())].alpha_mode == AlphaMode::mask)
        return census.alpha;
    if (triangles.size() == 2) {
      const double a = triangles[0].distance_m(at), b = triangles[1].distance_m(at);
      // Neighbors in one plane do not tie: both must cover the sample.
      const bool both_cover = triangles[0].inside_px(at) > 0.0 && triangles[1].inside_px(at) > 0.0;
      if (both_cover && std::fabs(a - b) < kTie * std::fabs(a)) return census.tie;
    }
    return census.other;
  }

  void report(const Seen& emulated, const Seen& traced, const std::vector<Projected>& triangles,
              glm::dvec2 at) {
    ++reported_;
    std::printf("  other at (%.4f, %.4f): emulated %d/%u, traced %d/%u;", at.x, at.y, emulated.instance,
                emulated.primitive, traced.instance, traced.primitive);
    for (const Projected& t : triangles)
      std::printf(" %.6f px inside at %.6f m;", t.inside_px(at), t.distance_m(at));
    std::printf("\n");
  }

  const Scene& scene_;
  std::uint64_t reported_ = 0;
};

/// Rays read textures at the finest level; so shall the rasterizer.
std::shared_ptr<const Scene> without_mip_levels(Scene scene) {
  for (Sampler& sampler : scene.samplers) {
    sampler.mip = MipFilter::none;
    sampler.min = sampler.mag;
    sampler.max_anisotropy = 1;
  }
  return std::make_shared<const Scene>(std::move(scene));
}

Census compare_visibility(std::shared_ptr<const Scene> scene) {
  ReferenceOptions options;
  options.width = kWidth;
  options.height = kHeight;
  options.jobs = 2;
  for (const SamplePosition& p : standard_sample_positions(kSamples))
    options.offsets_px.emplace_back(static_cast<float>(p.x) / 16, static_cast<float>(p.y) / 16);
  const std::vector<Visibility> traced =
      trace_visibility(ReferenceScene(*scene, texture_alpha(*scene), 2), options);
  const std::vector<Seen> emulated = IdFrame(scene).emulate_samples();
  Classifier classifier(*scene);
  for (std::size_t i = 0; i < traced.size(); ++i) {
    const std::size_t pixel = i / kSamples;
    const glm::vec2 offset = options.offsets_px[i % kSamples];
    const glm::dvec2 at(static_cast<double>(pixel % kWidth) + 0.5 + offset.x,
                        static_cast<double>(pixel / kWidth) + 0.5 + offset.y);
    const Seen ray = traced[i] ? Seen{static_cast<int>(traced[i].instance), traced[i].primitive} : Seen{};
    classifier.count(emulated[i], ray, at);
  }
  return classifier.census;
}

void expect_same_visibility(const std::string& name, const std::string& cache) {
  const Census c = compare_visibility(without_mip_levels(open_scene(name, cache)));
  std::printf(
      "%s: %llu samples, %.4f %% equal (%.4f %% off edges); edge %llu, tie %llu, alpha %llu, other %llu\n",
      std::filesystem::path(name).filename().c_str(), static_cast<unsigned long long>(c.samples),
      c.agreement_pct(), c.agreement_off_edges_pct(), static_cast<unsigned long long>(c.edge),
      static_cast<unsigned long long>(c.tie), static_cast<unsigned long long>(c.alpha),
      static_cast<unsigned long long>(c.other));
  EXPECT_EQ(c.samples, std::uint64_t{kWidth} * kHeight * kSamples);
  EXPECT_EQ(c.equal + c.edge + c.tie + c.alpha + c.other, c.samples);
  EXPECT_GE(c.agreement_pct(), 99.9) << name;
  EXPECT_GE(c.agreement_off_edges_pct(), 99.96) << name;
  EXPECT_LE(c.alpha, c.samples / 10000) << name;  // texture coordinates differ in their last bits
  EXPECT_EQ(c.other, 0u) << name;
}

TEST(Visibility, OfRaysAndRasterizerAgreesOnGeneratedScenes) {
  const pipeline::test::TemporaryFolder folder("visibility");
  for (const char* name : {"dragon:triangles=100000", "sponza_hall:bays=8,fov_deg=60", "grass:blades=5000"})
    expect_same_visibility(name, folder.path());
}

TEST(Visibility, OfRaysAndRasterizerAgreesOnRealScenes) {
  const std::filesystem::path scenes = std::filesystem::path(hwsim::test::shared_dir()) / "scenes";
  if (!std::filesystem::exists(scenes)) GTEST_SKIP() << "the real scenes are not here";
  for (const char* name : {"dragon_small.glb", "sponza.glb"})
    expect_same_visibility((scenes / name).string(), "");
}

}  // namespace
}  // namespace hwsim::oracle
