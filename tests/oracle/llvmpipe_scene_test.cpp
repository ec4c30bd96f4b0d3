// Whole passes against llvmpipe: depth and primitive of every sample. Both are given the same clip
// coordinates. They round window coordinates to 1/256 px by other roads (double and float), clip otherwise
// and evaluate depth in another order, so samples may differ where one of these decides, and nowhere else:
// each difference is put into a class.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "oracle/exact_coverage.h"
#include "oracle/llvmpipe.h"
#include "oracle/random_triangles.h"
#include "pipeline/open/scene_source.h"
#include "pipeline/state/sample_pattern.h"
#include "support/frames.h"
#include "support/places.h"

namespace hwsim::oracle {
namespace {
using namespace pipeline;

struct ClipTriangle {
  glm::vec4 v[3];
};

/// All triangles of a scene in clip space, by the vertex program's own arithmetic, in order of submission.
std::vector<ClipTriangle> clip_triangles(const Scene& scene, const DrawBatch& batch) {
  std::vector<ClipTriangle> all;
  auto vertices = std::make_unique<VertexBatch>();
  for (const DrawCall& call : batch.draws) {
    const Instance& instance = scene.instances[static_cast<std::size_t>(call.instance)];
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    const Mesh::Part& part = mesh.parts[static_cast<std::size_t>(call.part)];
    std::vector<glm::vec4> clip(mesh.positions.size());
    vertices->world_from_local = &instance.world_from_local[0][0];
    for (std::size_t first = 0; first < clip.size(); first += kBatchLanes) {
      vertices->count = static_cast<int>(std::min<std::size_t>(kBatchLanes, clip.size() - first));
      for (int i = 0; i < vertices->count; ++i)
        for (int k = 0; k < 3; ++k)
          vertices->position[k][i] = mesh.positions[first + static_cast<std::size_t>(i)][k];
      batch.vertex->run(*vertices, batch.vertex_uniforms.get());
      for (int i = 0; i < vertices->count; ++i)
        for (int k = 0; k < 4; ++k)
          clip[first + static_cast<std::size_t>(i)][k] = vertices->clip_position[k][i];
    }
    for (std::uint32_t i = 0; i < part.index_count; i += 3) {
      const std::uint32_t* index = mesh.indices.data() + part.first_index + i;
      all.push_back({{clip[index[0]], clip[index[1]], clip[index[2]]}});
    }
  }
  return all;
}

ClipMesh to_gl(const std::vector<ClipTriangle>& triangles) {
  ClipMesh mesh;
  for (const ClipTriangle& t : triangles)
    for (const glm::vec4& p : t.v) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back({p.x, p.y, p.z, p.w});
    }
  return mesh;
}

struct Classes {
  std::uint64_t drawn = 0, differing = 0, edges = 0, ties = 0, clipped = 0, unexplained = 0;
  double largest_depth_error = 0.0;  ///< where the primitives agree
};

/// One sample against one triangle, in double precision.
class Judge {
 public:
  Judge(int width, int height) : width_(width), height_(height) {}

  static bool is_clipped(const ClipTriangle& t) {
    return std::any_of(std::begin(t.v), std::end(t.v), [](const glm::vec4& p) {
      return p.w <= 0 || p.z < 0 || p.z > p.w || std::fabs(p.x) > p.w || std::fabs(p.y) > p.w;
    });
  }

  /// Distance to the nearest edge in pixels. Snapping moves a vertex by at most 1/512 px of its own, rounding
  /// in float by 1/256 more at these sizes.
  double edge_distance(const ClipTriangle& t, double x, double y) const {
    glm::dvec2 p[3];
    for (int i = 0; i < 3; ++i) p[i] = screen(t.v[i]);
    double nearest = 1e30;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec2 a = p[i], d = p[(i + 1) % 3] - a, r = glm::dvec2(x, y) - a;
      const double length2 = glm::dot(d, d);
      const double along = length2 > 0 ? std::clamp(glm::dot(r, d) / length2, 0.0, 1.0) : 0.0;
      nearest = std::min(nearest, glm::length(r - d * along));
    }
    return nearest;
  }

  /// Depth of its plane, and by how much it changes when the triangle moves by 1/128 px.
  double depth(const ClipTriangle& t, double x, double y, double& uncertainty) const {
    glm::dvec2 p[3];
    double z[3];
    for (int i = 0; i < 3; ++i) {
      p[i] = screen(t.v[i]);
      z[i] = static_cast<double>(t.v[i].z) / static_cast<double>(t.v[i].w);
    }
    const glm::dvec2 u = p[1] - p[0], v = p[2] - p[0], r = glm::dvec2(x, y) - p[0];
    const double area = u.x * v.y - u.y * v.x;
    const double l1 = (r.x * v.y - r.y * v.x) / area, l2 = (u.x * r.y - u.y * r.x) / area;
    const double dx = ((z[1] - z[0]) * v.y - (z[2] - z[0]) * u.y) / area;
    const double dy = (-(z[1] - z[0]) * v.x + (z[2] - z[0]) * u.x) / area;
    uncertainty = (std::fabs(dx) + std::fabs(dy)) / 128 + 4e-7;
    return z[0] + (z[1] - z[0]) * l1 + (z[2] - z[0]) * l2;
  }

 private:
  glm::dvec2 screen(const glm::vec4& p) const {
    const glm::dvec4 d(p);
    return {(d.x / d.w * 0.5 + 0.5) * width_, (0.5 - d.y / d.w * 0.5) * height_};
  }
  int width_, height_;
};

class LlvmpipeScene : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string why_not;
    llvmpipe_ = Llvmpipe::create(why_not);
    if (!llvmpipe_) GTEST_SKIP() << "llvmpipe is not available: " << why_not;
  }

  static void classify(const std::vector<ClipTriangle>& triangles, const Judge& judge, std::uint32_t ours,
                       std::uint32_t theirs, double x, double y, Classes& classes) {
    ++classes.differing;
    double near_edge = 1e30, z[2] = {1, 1}, slack[2] = {0, 0};
    bool clipped = false;
    int i = 0;
    for (const std::uint32_t id : {ours, theirs}) {
      if (id != 0) {
        const ClipTriangle& t = triangles[id - 1];
        clipped = clipped || Judge::is_clipped(t);
        near_edge = std::min(near_edge, judge.edge_distance(t, x, y));
        z[i] = judge.depth(t, x, y, slack[i]);
      }
      ++i;
    }
    if (clipped)
      ++classes.clipped;
    else if (near_edge < 1.0 / 128)
      ++classes.edges;
    else if (ours != 0 && theirs != 0 && std::fabs(z[0] - z[1]) <= slack[0] + slack[1])
      ++classes.ties;
    else
      ++classes.unexplained;
  }

  Classes compare(const std::shared_ptr<const Scene>& scene, int samples) {
    constexpr int kWidth = 320, kHeight = 192;
    test::SampleFrame frame(scene, kWidth, kHeight, samples, Format::r32_uint);
    const Camera& camera = scene->cameras.front();
    const glm::mat4 clip =
        clip_from_view(camera, static_cast<float>(kWidth) / kHeight) * camera.view_from_world;
    DrawBatch batch = frame.all_draws(mesh_position_program(), &test::primitive_program(), clip);
    batch.state.depth = {true, true, Compare::less};
    const std::vector<ClipTriangle> triangles = clip_triangles(*scene, batch);
    frame.draw("ids", {batch});
    const Image ours = frame.run().color;
    const SampleImage theirs = llvmpipe_->render(
        {.width = kWidth, .height = kHeight, .samples = samples, .depth_test = DepthTest::less},
        std::vector{to_gl(triangles)});
    const auto positions = standard_sample_positions(samples);
    const Judge judge(kWidth, kHeight);
    Classes classes;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        for (int s = 0; s < samples; ++s) {
          const glm::vec4& mine = ours.at(x * samples + s, y);
          const auto id = static_cast<std::uint32_t>(mine.x);
          const std::size_t i = theirs.index(x, y, s);
          classes.drawn += id != 0 ? 1 : 0;
          const SamplePosition p = positions[static_cast<std::size_t>(s)];
          if (id != theirs.primitive[i])
            classify(triangles, judge, id, theirs.primitive[i], x + 0.5 + p.x / 16.0, y + 0.5 + p.y / 16.0,
                     classes);
          else
            classes.largest_depth_error =
                std::max(classes.largest_depth_error,
                         std::fabs(static_cast<double>(mine.y) - static_cast<double>(theirs.depth[i])));
        }
    return classes;
  }

  void expect_explained(const std::string& name) {
    const auto scene = test::share(open_scene(name, hwsim::test::binary_dir() + "/test_scenes"));
    for (const int samples : {1, 4}) {
      const Classes c = compare(scene, samples);
      std::printf(
          "[     note ] %s, %d samples: %llu drawn, %llu differ (edges %llu, depth ties %llu, clipped %llu, "
          "unexplained %llu), depth error %.2g\n",
          scene->name.c_str(), samples, static_cast<unsigned long long>(c.drawn),
          static_cast<unsigned long long>(c.differing), static_cast<unsigned long long>(c.edges),
          static_cast<unsigned long long>(c.ties), static_cast<unsigned long long>(c.clipped),
          static_cast<unsigned long long>(c.unexplained), c.largest_depth_error);
      EXPECT_GT(c.drawn, 5000u * static_cast<unsigned>(samples));
      EXPECT_EQ(c.unexplained, 0u);
      EXPECT_LT(static_cast<double>(c.differing), 1e-3 * static_cast<double>(c.drawn));
      EXPECT_LT(c.largest_depth_error, 1e-4);
    }
  }

  std::unique_ptr<Llvmpipe> llvmpipe_;
};

TEST_F(LlvmpipeScene, ShowsTheSamePrimitivesOfGeneratedScenes) {
  for (const char* name : {"sponza_hall", "dragon"}) expect_explained(name);
}

TEST_F(LlvmpipeScene, ShowsTheSamePrimitivesOfScannedScenes) {
  int found = 0;
  for (const char* file : {"dragon_small.glb", "sponza.glb"}) {
    const std::string path = hwsim::test::shared_dir() + "/scenes/" + file;
    if (!std::filesystem::exists(path)) continue;
    ++found;
    expect_explained(path);
  }
  if (found == 0) GTEST_SKIP() << "the scene files are not here";
}

/// Unclipped triangles whose clip coordinates are exact: no rounding is left, so no sample may differ.
TEST_F(LlvmpipeScene, ShowsTheSameTrianglesWhereNothingRounds) {
  constexpr int kSize = 64;
  std::uint64_t drawn = 0;
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    TriangleGenerator generator(kSize, kSize, seed);
    std::vector<FixedTriangle> fixed = generator.partition(40);
    for (const TriangleKind kind :
         {TriangleKind::sliver, TriangleKind::tie, TriangleKind::axis_aligned, TriangleKind::tiny})
      for (const FixedTriangle& t : generator.make(kind, 25)) fixed.push_back(t);
    std::erase_if(fixed, [](const FixedTriangle& t) {  // what the view volume would cut
      return std::any_of(t.vertices.begin(), t.vertices.end(), [](const FixedVertex& v) {
        return std::min(v.x, v.y) < 0 || std::max(v.x, v.y) > kSize * 256;
      });
    });
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> indices;
    for (const FixedTriangle& t : fixed)
      for (const FixedVertex& v : t.vertices) {
        indices.push_back(static_cast<std::uint32_t>(positions.size()));
        positions.emplace_back(static_cast<float>(v.x) / (kSize * 128) - 1.0f,
                               1.0f - static_cast<float>(v.y) / (kSize * 128), 0.5f);
      }
    const auto scene = test::share(test::clip_space_scene(positions, indices));
    for (const int samples : {1, 2, 4, 8, 16}) {
      test::SampleFrame frame(scene, kSize, kSize, samples, Format::r32_uint);
      frame.draw("ids", {frame.all_draws(mesh_position_program(), &test::primitive_program())});
      const Image ours = frame.run().color;
      const SampleImage theirs =
          llvmpipe_->render({.width = kSize, .height = kSize, .samples = samples}, fixed);
      const SampleImage exact = exact_coverage(fixed, kSize, kSize, samples);
      std::uint64_t differing = 0;
      for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
          for (int s = 0; s < samples; ++s) {
            const auto id = static_cast<std::uint32_t>(ours.at(x * samples + s, y).x);
            drawn += id != 0 ? 1 : 0;
            differing +=
                id != theirs.primitive[theirs.index(x, y, s)] || id != exact.primitive[exact.index(x, y, s)];
          }
      EXPECT_EQ(differing, 0u) << "seed " << seed << ", " << samples << " samples";
    }
  }
  EXPECT_GT(drawn, 100000u);
}

}  // namespace
}  // namespace hwsim::oracle
