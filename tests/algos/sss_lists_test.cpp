// Selective supersampling by per-pixel lists (docs/techniques/sss.md#tests): coverage, order, visibility,
// overflow.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "algos/sss/shaders/counters.h"
#include "algos/sss/shaders/programs.h"
#include "algos/sss_scenes.h"
#include "hwsim/base/diagnostics.h"

// One vector target is enough here: without foreach_target.
#include "algos/sss/shaders/pixel-inl.h"
#include "pipeline/simd/scalar_lane-inl.h"

namespace hwsim::test {
namespace {
using namespace pipeline;
using namespace sss;

// Half the pixel's places lie on edges of a fan through them; each must be in exactly one triangle.
TEST(SssLists, PlacesOnSharedEdgesBelongToOneTriangle) {
  using F = pipeline::HWY_NAMESPACE::ScalarF;
  std::mt19937 random(7);
  const auto uniform = [&](int low, int high) {
    return static_cast<float>(static_cast<int>(random() % static_cast<unsigned>(high - low + 1)) + low);
  };
  for (int round = 0; round < 2000; ++round) {
    const int m = 2 << (round % 3), step = 256 / m;
    // A square around the pixel and a hub that often hits a place or a row of them.
    const float hub_x = round % 2 == 0 ? uniform(0, 2 * m) * static_cast<float>(step) / 2 : uniform(0, 256);
    const float hub_y = uniform(0, 2 * m) * static_cast<float>(step) / 2;
    const float rim[8][2] = {{-300, -300}, {hub_x, -300}, {600, -300}, {600, hub_y},
                             {600, 600},   {hub_x, 600},  {-300, 600}, {-300, hub_y}};
    std::vector<int> found(static_cast<std::size_t>(m * m), 0);
    for (int t = 0; t < 8; ++t) {
      const auto *p = rim[t], *q = rim[(t + 1) % 8];
      algos::HWY_NAMESPACE::PixelTriangle<F> triangle;
      const bool turned = (round & 4) != 0;
      const float x[3] = {hub_x, turned ? q[0] : p[0], turned ? p[0] : q[0]};
      const float y[3] = {hub_y, turned ? q[1] : p[1], turned ? p[1] : q[1]};
      for (int v = 0; v < 3; ++v) {
        triangle.x[v] = x[(v + t) % 3];
        triangle.y[v] = y[(v + t) % 3];
      }
      triangle.area2 = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
      if (triangle.area2.v == 0.0f) continue;
      const algos::HWY_NAMESPACE::PixelEdges<F> edges(triangle);
      for (int i = 0; i < m * m; ++i) {
        const F px((static_cast<float>(i % m) + 0.5f) * static_cast<float>(step));
        const F py((static_cast<float>(i / m) + 0.5f) * static_cast<float>(step));
        found[static_cast<std::size_t>(i)] += edges.cover(px, py).v ? 1 : 0;
      }
    }
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_EQ(found[i], 1) << round << " place " << i;
  }
}

TEST(SssLists, ListsDoNotShowTheOrderOfInsertion) {
  const auto scene = rods();
  Scene shuffled = *scene;
  Mesh& mesh = shuffled.meshes[0];
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    triangles.push_back({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
  std::shuffle(triangles.begin(), triangles.end(), std::mt19937(3));
  mesh.indices.clear();
  for (const auto& t : triangles) mesh.indices.insert(mesh.indices.end(), t.begin(), t.end());
  for (const char* node : {"12", "16", "32"}) {
    const std::string technique =
        std::string("sss_ppll:mode=or,early_exit=off,list_cap=64,node_bytes=") + node;
    const Emulation a = run(scene, technique);
    const Emulation b = run(std::make_shared<const Scene>(shuffled), technique);
    EXPECT_GT(counters(a)[algos::SssCounters::sss_list_4_to_7_pixels], 0u);
    EXPECT_EQ(counters(a)[algos::SssCounters::sss_truncated_pixels], 0u);
    EXPECT_EQ(difference(a.color, b.color, "image"), "") << node;
  }
}

TEST(SssLists, FullListsAreCountedAndBoxesAndConservativeRasterAgree) {
  const auto scene = rods();
  const std::string all = "sss_ppll:mode=or,early_exit=off";
  const Emulation whole = run(scene, all);
  const std::uint64_t stored = counters(whole)[algos::SssCounters::sss_stored_fragments];
  EXPECT_EQ(counters(whole)[algos::SssCounters::sss_dropped_fragments], 0u);
  const Emulation little = run(scene, all + ",capacity_nodes=" + std::to_string(stored / 2));
  EXPECT_EQ(counters(little)[algos::SssCounters::sss_stored_fragments], stored / 2);
  EXPECT_EQ(counters(little)[algos::SssCounters::sss_dropped_fragments], stored - stored / 2);
  const Emulation raster = run(scene, all + ",conservative=raster");
  EXPECT_EQ(difference(whole.color, raster.color, "image"), "");
  EXPECT_EQ(counters(raster)[algos::SssCounters::sss_stored_fragments], stored);
  const auto fragments = [](const Emulation& e) {
    return total(pass_named(e.trace, "sample")).raster.fragments;
  };
  EXPECT_LT(fragments(raster), fragments(whole));
  const TechniqueCounters n = counters(whole);
  EXPECT_GT(
      n[algos::SssCounters::sss_list_1_pixels] + n[algos::SssCounters::sss_list_2_to_3_pixels] +
          n[algos::SssCounters::sss_list_4_to_7_pixels] + n[algos::SssCounters::sss_list_8_to_15_pixels] +
          n[algos::SssCounters::sss_list_16_to_31_pixels] + n[algos::SssCounters::sss_list_from_32_pixels],
      0u);
}

TEST(SssLists, LongListsAreCutAndCounted) {
  const auto scene = rods();
  const std::string all = "sss_ppll:mode=or,early_exit=off,list_cap=";
  const TechniqueCounters whole = counters(run(scene, all + "64")), one = counters(run(scene, all + "1"));
  EXPECT_EQ(whole[algos::SssCounters::sss_truncated_pixels], 0u);
  const std::uint64_t longer = whole[algos::SssCounters::sss_list_2_to_3_pixels] +
                               whole[algos::SssCounters::sss_list_4_to_7_pixels] +
                               whole[algos::SssCounters::sss_list_8_to_15_pixels] +
                               whole[algos::SssCounters::sss_list_16_to_31_pixels] +
                               whole[algos::SssCounters::sss_list_from_32_pixels];
  EXPECT_GT(longer, 100u);
  EXPECT_EQ(one[algos::SssCounters::sss_truncated_pixels], longer);
  EXPECT_EQ(one[algos::SssCounters::sss_list_1_pixels],
            longer + whole[algos::SssCounters::sss_list_1_pixels]);
}

// "We manually discard these fragments": what a wall hides is dropped before its places are tested.
TEST(SssLists, HiddenFragmentsSkipTheLoops) {
  const auto lists_of = [](bool hidden) {
    Mesh mesh;
    add_cylinder(mesh, 0.0f, 0.04f, 10, 60, 0.02f);
    if (hidden) {
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const glm::vec2 corner :
           {glm::vec2(-4, -3), glm::vec2(4, -3), glm::vec2(4, 3), glm::vec2(-4, 3)}) {
        mesh.positions.push_back({corner, 1.0f});
        mesh.normals.push_back({0.0f, 0.0f, 1.0f});
      }
      for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
    }
    return total(pass_named(
        run(finish(empty_scene(), std::move(mesh)), "sss_ppll:mode=or,early_exit=off").trace, "sample"));
  };
  const PassCounters seen = lists_of(false), hidden = lists_of(true);
  ASSERT_GT(seen.ps.invocations, 500u);
  EXPECT_EQ(hidden.ps.invocations, seen.ps.invocations);
  EXPECT_EQ(hidden.ps.discarded_invocations, hidden.ps.invocations);
  EXPECT_LT(hidden.shader.alu_lane_ops, seen.shader.alu_lane_ops / 3);
}

// 5.4: where the covered parts add up to the pixel, the frame below shows nothing of itself.
TEST(SssLists, FullListsLeaveNothingOfTheFrame) {
  Mesh mesh;
  add_cylinder(mesh, 0.0f, 0.9f, 48, 40);
  const auto scene = finish(empty_scene(), std::move(mesh));
  const std::string all = "sss_ppll:mode=or,tri_px=1000,early_exit=off,rest=";
  const Image frame = run(scene, all + "frame").color, others = run(scene, all + "others").color;
  int shaded = 0;
  for (int y = kSssHeight / 2 - 12; y < kSssHeight / 2 + 12;
       ++y)  // the cylinder reaches over 18 rows on each side
    for (int x = 0; x < kSssWidth; ++x) {
      shaded += frame.at(x, y).x > 0.0f ? 1 : 0;
      for (int c = 0; c < 3; ++c) ASSERT_EQ(frame.at(x, y)[c], others.at(x, y)[c]) << x << ", " << y;
    }
  EXPECT_GT(shaded, 1000);
  EXPECT_GT(largest_difference(frame, run(scene, "msaa8x").color), 1.0f / 255.0f);
}

TEST(SssLists, ConservativeRasterNeedsTheGpu) {
  try {
    emulate(graph_of(rods(), "sss_ppll:conservative=raster"), GpuFeatures{}, FunctionalConfig{}, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().front().code, "G006");
  }
}

/// Two rods that cross and go through each other, and one behind them, all sampled.
std::shared_ptr<const Scene> crossing_rods() {
  Mesh mesh;
  add_cylinder(mesh, 0.0f, 0.16f, 24, 40, 0.8f);
  const std::size_t second = mesh.positions.size();
  add_cylinder(mesh, 0.05f, 0.1f, 24, 40, -0.6f);
  const std::size_t third = mesh.positions.size();
  add_cylinder(mesh, 0.3f, 0.05f, 24, 40, 0.7f);
  for (std::size_t i = second; i < mesh.positions.size(); ++i)
    mesh.positions[i].z += i < third ? 0.03f : -1.0f;
  return finish(empty_scene(), std::move(mesh));
}

double rms_difference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    sum += (a.pixels[i].x - b.pixels[i].x) * (a.pixels[i].x - b.pixels[i].x);
  return std::sqrt(sum / static_cast<double>(a.pixels.size()));
}

// 8x8 places of a pixel are where ssaa64x shades. With their planes and places in the nodes, silhouettes and
// where rods go through each other are seen as there; without, as by the frame's eight samples.
TEST(SssLists, NodesHideEachOtherPlaceByPlace) {
  const auto scene = crossing_rods();
  const std::string all =
      "sss_ppll:mode=or,early_exit=off,theta_c=0.01,tri_px=1000,m=8,list_cap=64,node_bytes=";
  const Image truth = run(scene, "ssaa64x").color;
  const Emulation coverage = run(scene, all + "16"), places = run(scene, all + "32");
  EXPECT_EQ(counters(places)[algos::SssCounters::sss_dropped_fragments], 0u);
  const double by_coverage = rms_difference(coverage.color, truth),
               by_place = rms_difference(places.color, truth);
  EXPECT_LT(by_place, 0.6 * by_coverage) << by_coverage;
  EXPECT_EQ(counters(places)[algos::SssCounters::sss_truncated_pixels], 0u);
  // A coarser grid's places stand for several.
  const std::string coarse =
      "sss_ppll:mode=or,early_exit=off,theta_c=0.01,tri_px=1000,node_bytes=32,list_cap=64,m=";
  const Image truth16 = run(scene, "ssaa16x").color;
  EXPECT_LT(rms_difference(run(scene, coarse + "4").color, truth16), 0.65 * by_coverage);
}

}  // namespace
}  // namespace hwsim::test
