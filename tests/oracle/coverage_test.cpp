#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "oracle/exact_coverage.h"
#include "oracle/llvmpipe.h"
#include "oracle/random_triangles.h"

namespace hwsim::oracle {
namespace {

constexpr int kSampleCounts[] = {1, 2, 4, 8, 16};

FixedTriangle triangle_px(double ax, double ay, double bx, double by, double cx, double cy) {
  const auto fixed = [](double px) { return static_cast<std::int32_t>(px * 256); };
  return {{FixedVertex{fixed(ax), fixed(ay), 0.5f}, FixedVertex{fixed(bx), fixed(by), 0.5f},
           FixedVertex{fixed(cx), fixed(cy), 0.5f}}};
}

std::vector<FixedVertex> corners(const FixedTriangle& t) { return {t.vertices.begin(), t.vertices.end()}; }

TEST(ExactCoverage, GivesSamplesOnTopAndLeftEdgesToTheTriangle) {
  const FixedTriangle upper_left = triangle_px(1, 1, 5, 1, 1, 5);
  EXPECT_TRUE(covers(upper_left, 2 * 256, 1 * 256));   // on the top edge
  EXPECT_TRUE(covers(upper_left, 1 * 256, 2 * 256));   // on the left edge
  EXPECT_TRUE(covers(upper_left, 1 * 256, 1 * 256));   // where both meet
  EXPECT_FALSE(covers(upper_left, 3 * 256, 3 * 256));  // on the right edge
  EXPECT_FALSE(covers(upper_left, 5 * 256, 1 * 256));  // top and right edge
  const FixedTriangle lower_right = triangle_px(5, 1, 5, 5, 1, 5);
  EXPECT_TRUE(covers(lower_right, 3 * 256, 3 * 256));   // the same edge is this one's left
  EXPECT_FALSE(covers(lower_right, 2 * 256, 5 * 256));  // on the bottom edge
  EXPECT_FALSE(covers(lower_right, 5 * 256, 3 * 256));  // on the right edge
}

TEST(ExactCoverage, IgnoresTheOrderOfVertices) {
  TriangleGenerator generator(24, 24, 1);
  for (const TriangleKind kind : kAllTriangleKinds)
    for (const FixedTriangle& triangle : generator.make(kind, 20)) {
      std::vector<FixedVertex> v = corners(triangle);
      const std::vector<std::uint32_t> first = exact_cover_counts({triangle}, 24, 24, 4);
      for (const auto& order :
           {std::array{0, 2, 1}, std::array{1, 0, 2}, std::array{1, 2, 0}, std::array{2, 1, 0}}) {
        const FixedTriangle turned{{v[static_cast<std::size_t>(order[0])],
                                    v[static_cast<std::size_t>(order[1])],
                                    v[static_cast<std::size_t>(order[2])]}};
        EXPECT_EQ(exact_cover_counts({turned}, 24, 24, 4), first) << name(kind);
      }
    }
}

TEST(ExactCoverage, CoversEverySampleOfAPartitionExactlyOnce) {
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    TriangleGenerator generator(20, 12, seed);
    const std::vector<FixedTriangle> partition = generator.partition(60);
    EXPECT_GT(partition.size(), 20u);
    for (const int samples : kSampleCounts)
      for (const std::uint32_t count : exact_cover_counts(partition, 20, 12, samples))
        ASSERT_EQ(count, 1u) << seed;
  }
}

TEST(ExactCoverage, CoversNoSampleOfAFanTwice) {
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const std::vector<FixedTriangle> fan = TriangleGenerator(48, 32, seed).fan(9);
    for (const int samples : kSampleCounts)
      for (const std::uint32_t count : exact_cover_counts(fan, 48, 32, samples)) ASSERT_LE(count, 1u) << seed;
  }
}

TEST(ExactCoverage, SplitsTheTargetBetweenTwoGuardBandTriangles) {
  const std::int32_t far = (1 << 23) - 1, across = 16 * 256;  // the shared edge is the target's diagonal
  const FixedVertex a{far, across - far, 0}, b{across - far, far, 0};
  const FixedTriangle upper{{a, b, FixedVertex{-far, -far, 0}}}, lower{{a, b, FixedVertex{far, far, 0}}};
  const std::vector<std::uint32_t> upper_alone = exact_cover_counts({upper}, 16, 16, 1);
  EXPECT_EQ(std::accumulate(upper_alone.begin(), upper_alone.end(), 0u),
            120u);  // the diagonal's 16 are the lower's
  for (const int samples : kSampleCounts)
    for (const std::uint32_t count : exact_cover_counts({upper, lower}, 16, 16, samples))
      EXPECT_EQ(count, 1u);
}

TEST(ExactCoverage, CoversNothingWithoutArea) {
  for (const std::uint32_t count :
       exact_cover_counts({triangle_px(0, 0, 4, 4, 8, 8), triangle_px(1, 1, 1, 1, 1, 1)}, 8, 8, 4))
    EXPECT_EQ(count, 0u);
}

TEST(TriangleGenerator, PutsSamplesOnEdgesInTheKindTie) {
  TriangleGenerator generator(16, 16, 3);
  int on_edges = 0;
  for (const FixedTriangle& t : generator.make(TriangleKind::tie, 200))
    for (const SampleOffset o : standard_offsets(16))
      for (const FixedVertex& v : t.vertices)
        on_edges += (v.x - 128 - o.x * 16) % 256 == 0 && (v.y - 128 - o.y * 16) % 256 == 0;
  EXPECT_GT(on_edges, 20);
}

class LlvmpipeCoverage : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string why_not;
    llvmpipe_ = Llvmpipe::create(why_not);
    if (!llvmpipe_) GTEST_SKIP() << "llvmpipe is not available: " << why_not;
  }
  // What llvmpipe would clip is left out: clipping moves samples at the borders.
  std::vector<FixedTriangle> unclipped(std::vector<FixedTriangle> triangles, int width, int height) const {
    const std::int32_t limit = llvmpipe_->unclipped_extent_px() * 256 - 32 * 256;
    const std::int32_t cx = width / 2 * 256, cy = height / 2 * 256;
    std::erase_if(triangles, [&](const FixedTriangle& t) {
      return std::any_of(t.vertices.begin(), t.vertices.end(), [&](const FixedVertex& v) {
        return std::abs(v.x - cx) > limit || std::abs(v.y - cy) > limit;
      });
    });
    return triangles;
  }
  std::size_t differences(const std::vector<FixedTriangle>& triangles, int width, int height, int samples) {
    const SampleImage gl =
        llvmpipe_->render({.width = width, .height = height, .samples = samples}, triangles);
    const SampleImage exact = exact_coverage(triangles, width, height, samples);
    std::size_t count = 0;
    for (std::size_t i = 0; i < exact.primitive.size(); ++i) count += exact.primitive[i] != gl.primitive[i];
    return count;
  }
  std::unique_ptr<Llvmpipe> llvmpipe_;
};

TEST_F(LlvmpipeCoverage, UsesTheStandardPositionsAtFourSamples) {
  const std::vector<SampleOffset> offsets = llvmpipe_->native_offsets(4);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(offsets[i].x, standard_offsets(4)[i].x);
    EXPECT_EQ(offsets[i].y, standard_offsets(4)[i].y);
  }
}

TEST_F(LlvmpipeCoverage, EqualsExactCoverageInEverySample) {
  constexpr int width = 96, height = 64;
  std::size_t drawn = 0;
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    TriangleGenerator generator(width, height, seed);
    std::vector<std::pair<std::string, std::vector<FixedTriangle>>> sets = {
        {"fan", generator.fan(12)}, {"partition", generator.partition(80)}};
    for (const TriangleKind kind : kAllTriangleKinds) {
      // Fewer of the large ones, which hide what was drawn before.
      const int count = kind == TriangleKind::guard_band || kind == TriangleKind::large ? 6 : 40;
      sets.emplace_back(name(kind), unclipped(generator.make(kind, count), width, height));
    }
    for (const auto& [kind, triangles] : sets)
      for (const int samples : kSampleCounts) {
        drawn += triangles.size();
        EXPECT_EQ(differences(triangles, width, height, samples), 0u)
            << kind << ", seed " << seed << ", " << samples << " samples";
      }
  }
  EXPECT_GT(drawn, 10000u);
}

TEST_F(LlvmpipeCoverage, KeepsTheNearestPrimitiveAndItsDepth) {
  FixedTriangle near = triangle_px(0, 0, 8, 0, 0, 8), far = triangle_px(0, 0, 8, 0, 8, 8);
  for (FixedVertex& v : near.vertices) v.depth = 0.25f;
  for (FixedVertex& v : far.vertices) v.depth = 0.75f;
  for (const int samples : kSampleCounts) {
    const SampleImage image = llvmpipe_->render(
        {.width = 8, .height = 8, .samples = samples, .depth_test = DepthTest::less}, std::vector{near, far});
    const auto at = [&](int x, int y) { return image.index(x, y, 0); };
    EXPECT_EQ(image.primitive[at(1, 1)], 1u);
    EXPECT_EQ(image.primitive[at(6, 4)], 2u);
    EXPECT_EQ(image.primitive[at(1, 7)], 0u);
    EXPECT_EQ(image.depth[at(1, 1)], 0.25f);
    EXPECT_EQ(image.depth[at(6, 4)], 0.75f);
    EXPECT_EQ(image.depth[at(1, 7)], 1.0f);
  }
}

ClipMesh clip_quad(float depth, std::uint32_t first_primitive) {
  ClipMesh mesh;
  mesh.positions = {{-1, -1, depth, 1}, {1, -1, depth, 1}, {1, 1, depth, 1}, {-1, 1, depth, 1}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  mesh.first_primitive = first_primitive;
  return mesh;
}

TEST_F(LlvmpipeCoverage, DrawsIndexedMeshesThroughTheirMatrixWithYUp) {
  ClipMesh mesh = clip_quad(0.5f, 10);
  mesh.clip_from_position[0] = mesh.clip_from_position[5] = 0.5f;  // half the size
  mesh.clip_from_position[13] = 0.5f;                              // moved up
  const SampleImage image =
      llvmpipe_->render({.width = 16, .height = 16, .cull = Cull::back}, std::vector{mesh});
  EXPECT_EQ(std::count_if(image.primitive.begin(), image.primitive.end(), [](auto id) { return id != 0; }),
            64);
  EXPECT_EQ(image.primitive[image.index(10, 6, 0)], 10u);  // the quad's lower right triangle
  EXPECT_EQ(image.primitive[image.index(5, 1, 0)], 11u);
  EXPECT_EQ(image.primitive[image.index(8, 12, 0)], 0u);
  std::reverse(mesh.indices.begin(), mesh.indices.end());
  const SampleImage culled =
      llvmpipe_->render({.width = 16, .height = 16, .cull = Cull::back}, std::vector{mesh});
  EXPECT_EQ(std::accumulate(culled.primitive.begin(), culled.primitive.end(), 0u), 0u);
}

TEST_F(LlvmpipeCoverage, TimesDrawsOfEveryKind) {
  const std::vector<FixedTriangle> triangles =
      TriangleGenerator(256, 128, 1).make(TriangleKind::general, 500);
  for (const DrawKind kind : {DrawKind::depth_only, DrawKind::gouraud})
    for (const int samples : {1, 4, 8}) {
      const double seconds = llvmpipe_->draw_seconds(
          {.width = 256, .height = 128, .samples = samples, .depth_test = DepthTest::less}, kind, triangles);
      EXPECT_GT(seconds, 0.0);  // the driver ran: how long it takes is for raster_benchmark
      std::printf("[     note ] 500 triangles, %d samples, %s: %.2f ms\n", samples,
                  kind == DrawKind::gouraud ? "Gouraud" : "depth only", seconds * 1e3);
    }
}

}  // namespace
}  // namespace hwsim::oracle
