// Coverage at more positions than samples (docs/techniques/forward.md#coverage-sampling): memory, maps by
// hand, and pictures against multisampling at all positions.
#include "pipeline/memory/coverage_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "pipeline/state/sample_pattern.h"
#include "support/frames.h"

namespace hwsim::pipeline {
namespace {

constexpr int kSize = 24;

std::shared_ptr<const Scene> triangles(const std::vector<glm::vec3>& positions) {
  std::vector<std::uint32_t> indices(positions.size());
  for (std::uint32_t i = 0; i < indices.size(); ++i) indices[i] = i;
  return test::share(test::clip_space_scene(positions, indices));
}

/// The resolved red of the scene's triangles, each in the color of its number. With `coverage`: maps of as
/// many positions; else `samples` at the positions given, in their order.
struct Frame {
  explicit Frame(std::shared_ptr<const Scene> scene, int samples, int coverage, bool drop_orphans = false,
                 const std::vector<SamplePosition>& at = {})
      : graph(std::move(scene), kSize, kSize) {
    const ImageId color = graph.add_image({"color", Format::r32_float, kSize, kSize, samples, 1, coverage});
    const ImageId depth = graph.add_image({"depth", Format::d32_float, kSize, kSize, samples});
    graph.add_clear("clear", {color, depth});
    Pass& pass = graph.add_pass("draw", PassKind::draw);
    pass.samples = samples;
    pass.coverage_samples = coverage;
    pass.drop_orphans = drop_orphans;
    pass.color = {color};
    pass.depth = depth;
    DrawBatch batch;
    batch.vertex = &mesh_position_program();
    batch.vertex_uniforms = std::make_shared<MeshVertexUniforms>();
    batch.fragment = &test::primitive_program();
    batch.state.raster.cull = CullMode::none;
    batch.state.raster.sample_positions = at;
    batch.state.depth = {true, true, Compare::less};
    batch.draws = {{0, 0}};
    pass.batches = {batch};
    const ImageId out = graph.add_image({"out", Format::r32_float, kSize, kSize, 1});
    graph.add_resolve("resolve", color, out);
    graph.set_output(out);
  }
  Emulation run() const {
    GpuFeatures features = every_feature(32);
    features.coverage_samples_max = 32;
    return emulate(graph, features, FunctionalConfig{}, {});
  }
  FrameGraph graph;
};

TEST(CoverageMap, TakesWholeBytesOfAPixel) {
  EXPECT_EQ(coverage_map_bytes(4, 8), 3u);   // an entry has 3 bits
  EXPECT_EQ(coverage_map_bytes(4, 16), 6u);  // an entry has 3 bits
  EXPECT_EQ(coverage_map_bytes(8, 16), 8u);  // an entry has 4 bits
  EXPECT_EQ(coverage_map_bytes(8, 32), 16u);
  EXPECT_EQ(coverage_map_bytes(2, 4), 1u);  // an entry has 2 bits
  EXPECT_EQ(coverage_map_bytes(8, 0), 0u);
  const ImageDesc image{"color", Format::rgba8_unorm, 100, 10, 4, 1, 16};
  EXPECT_EQ(allocated_bytes(image), 1000u * (4 * 4 + 6));
}

/// The least sum of squared distances between samples and positions, one each: over sets of samples that the
/// first positions stand for.
int least_distance2(std::span<const SamplePosition> samples, std::span<const SamplePosition> positions) {
  constexpr int kNever = 1 << 20;
  std::vector<int> least(std::size_t{1} << samples.size(), kNever);
  least[0] = 0;
  for (const SamplePosition p : positions)
    for (std::size_t taken = least.size(); taken-- > 0;)
      for (std::size_t k = 0; k < samples.size(); ++k) {
        if ((taken >> k & 1u) != 0) continue;
        const int dx = samples[k].x - p.x, dy = samples[k].y - p.y;
        int& next = least[taken | std::size_t{1} << k];
        next = std::min(next, least[taken] + dx * dx + dy * dy);
      }
  return least.back();
}

TEST(CoverageMap, PositionsAreTheSamplesAndWhatLiesFarthestFromThem) {
  const auto same = [](SamplePosition a, SamplePosition b) { return a.x == b.x && a.y == b.y; };
  for (const auto& [samples, positions] : {std::pair(2, 4), {4, 8}, {4, 16}, {8, 16}, {8, 32}}) {
    const std::vector<SamplePosition> found = coverage_positions(samples, positions);
    const auto own = standard_sample_positions(samples), all = standard_sample_positions(positions);
    ASSERT_EQ(found.size(), all.size());
    EXPECT_TRUE(std::equal(own.begin(), own.end(), found.begin(), same));
    std::vector<SamplePosition> replaced;
    for (const SamplePosition p : all)
      if (std::none_of(found.begin() + samples, found.end(), [&](SamplePosition f) { return same(f, p); }))
        replaced.push_back(p);
    ASSERT_EQ(replaced.size(), own.size());
    EXPECT_EQ(least_distance2(own, replaced), least_distance2(own, all)) << samples << " of " << positions;
  }
}

// Four samples, eight positions; the fragments' masks by hand.
TEST(CoverageMap, FollowsFragmentsByHand) {
  const auto never = [](int, int) { return false; };
  const auto always = [](int, int) { return true; };
  const CoverageWord clear;
  const CoverageLayout& layout = coverage_layout(4, 8);
  // Half of the pixel: samples 0, 1, positions 4, 5. The rest stays with a sample of the background.
  const CoverageWord half = insert_fragment(clear, layout, 0b0011, 0b00110011, false, never);
  for (const int q : {0, 1, 4, 5}) EXPECT_EQ(half.at(q), 0u) << q;
  for (const int q : {2, 3, 6, 7}) EXPECT_EQ(half.at(q), 2u) << q;
  // Dropped instead.
  const CoverageWord dropped = insert_fragment(clear, layout, 0b0011, 0b00110011, true, never);
  EXPECT_EQ(dropped.at(6), kNoSample);
  EXPECT_EQ(dropped.at(4), 0u);
  // A third surface takes the background's samples: its positions have no color left.
  const CoverageWord third = insert_fragment(half, layout, 0b1100, 0b01001100, false, never);
  EXPECT_EQ(third.at(6), 2u);
  EXPECT_EQ(third.at(7), kNoSample);
  EXPECT_EQ(third.at(4), 0u) << "hidden, or not covered: as before";
  // Over what the other sample holds it wins only in front of it.
  EXPECT_EQ(insert_fragment(half, layout, 0b1000, 0b11111000, false, never).at(4), 0u);
  EXPECT_EQ(insert_fragment(half, layout, 0b1000, 0b11111000, false, always).at(4), 3u);
  // Without a sample of its own it hides what it covers.
  EXPECT_EQ(hide_positions(half, layout, 0b00110000, always).at(4), kNoSample);
  EXPECT_EQ(hide_positions(half, layout, 0b00110000, never).at(4), 0u);
}

// A small triangle of a surface covers position 4 alone; the surface has the nearest sample, or gets it
// later.
TEST(CoverageMap, HiddenPositionsStandForTheNearestSample) {
  const auto never = [](int, int) { return false; };
  const auto always = [](int, int) { return true; };
  const CoverageLayout& layout = coverage_layout(4, 8);
  const std::uint32_t nearest = layout.nearest_sample[4], far = (nearest + 1) % 4;
  const CoverageWord hidden = hide_positions(CoverageWord(), layout, 0b00010000, always);
  EXPECT_EQ(layout.shown_at(hidden, 4), nearest);
  EXPECT_EQ(layout.shown_at(hidden, 5), 0u);
  // What is drawn behind the nearest sample's surface does not come forward here.
  const std::uint32_t behind = 1u << far | 0b11110000u;
  EXPECT_EQ(insert_fragment(hidden, layout, 1u << far, behind, false, never).at(4), kNoSample);
  EXPECT_EQ(insert_fragment(hidden, layout, 1u << far, behind, false, always).at(4), far);
  // The surface's own triangle at the nearest sample does not cover the position, but shows there.
  const CoverageWord later = insert_fragment(hidden, layout, 1u << nearest, 1u << nearest, false, never);
  EXPECT_EQ(layout.shown_at(later, 4), nearest);
}

TEST(CoverageMap, NearestSamplesAreNearest) {
  for (const auto& [samples, positions] : {std::pair(2, 4), {4, 8}, {4, 16}, {8, 16}, {8, 32}}) {
    const std::vector<SamplePosition> at = coverage_positions(samples, positions);
    const CoverageLayout& layout = coverage_layout(samples, positions);
    const auto distance = [&](std::size_t q, std::size_t k) {
      return std::hypot(at[q].x - at[k].x, at[q].y - at[k].y);
    };
    for (std::size_t q = 0; q < at.size(); ++q)
      for (std::size_t k = 0; k < static_cast<std::size_t>(samples); ++k)
        EXPECT_LE(distance(q, layout.nearest_sample[q]), distance(q, k)) << q << " " << k;
  }
  EXPECT_THROW(coverage_layout(4, 32), std::invalid_argument);
}

// One triangle over a clear image: every pixel in which it has a sample and the background has one weighs it
// by all positions, exactly as multisampling at these positions does.
TEST(CoverageMap, MeetsMultisamplingWhereSamplesSuffice) {
  std::mt19937 random(3);
  const auto next = [&] { return static_cast<float>(random() % 2401) / 1000.0f - 1.2f; };
  for (const auto& [samples, positions] : {std::pair(2, 4), {4, 8}, {4, 16}, {8, 16}}) {
    int edges = 0, differing = 0;
    double error = 0.0, coarse_error = 0.0;
    for (int i = 0; i < 20; ++i) {
      const std::vector<glm::vec3> t = {
          {next(), next(), 0.5f}, {next(), next(), 0.5f}, {next(), next(), 0.5f}};
      const Emulation ours = Frame(triangles(t), samples, positions).run();
      const Emulation fine =
          Frame(triangles(t), positions, 0, false, coverage_positions(samples, positions)).run();
      const Emulation coarse = Frame(triangles(t), samples, 0).run();
      for (std::size_t p = 0; p < fine.color.pixels.size(); ++p) {
        const float expected = fine.color.pixels[p].x, found = ours.color.pixels[p].x;
        if (expected == 0.0f || expected == 1.0f) continue;
        ++edges;
        differing += found != expected ? 1 : 0;
        // Without a sample of the triangle, or of the background, the pixel is the other's.
        EXPECT_TRUE(found == expected || found == 0.0f || found == 1.0f) << p;
        error += std::abs(found - expected);
        coarse_error += std::abs(coarse.color.pixels[p].x - expected);
      }
    }
    EXPECT_GT(edges, 300);
    EXPECT_LT(differing, edges * 2 / 5) << samples << " of " << positions;
    EXPECT_LT(error, coarse_error) << samples << " of " << positions;
  }
}

// More positions than any GPU's programmable ones: beside multisampling at 32 positions of its own.
TEST(CoverageMap, ThirtyTwoPositionsWeighEdgesFiner) {
  std::mt19937 random(5);
  const auto next = [&] { return static_cast<float>(random() % 2401) / 1000.0f - 1.2f; };
  double error = 0.0, coarse_error = 0.0;
  int finer = 0;
  for (int i = 0; i < 20; ++i) {
    const std::vector<glm::vec3> t = {{next(), next(), 0.5f}, {next(), next(), 0.5f}, {next(), next(), 0.5f}};
    const Emulation ours = Frame(triangles(t), 8, 32).run(), coarse = Frame(triangles(t), 8, 0).run(),
                    fine = Frame(triangles(t), 32, 0).run();
    for (std::size_t p = 0; p < fine.color.pixels.size(); ++p) {
      const float expected = fine.color.pixels[p].x, found = ours.color.pixels[p].x;
      EXPECT_EQ(32.0f * found, std::round(32.0f * found)) << p;
      finer += 8.0f * found != std::round(8.0f * found) ? 1 : 0;
      error += std::abs(found - expected);
      coarse_error += std::abs(coarse.color.pixels[p].x - expected);
    }
  }
  EXPECT_GT(finer, 200);
  EXPECT_LT(error, 0.6 * coarse_error);
}

// Two triangles that share an edge and fill the frame: weights of 1 together, in either order of drawing.
TEST(CoverageMap, TwoHalvesFillThePixel) {
  const std::vector<glm::vec3> a = {{-1, -1, 0.25f}, {1, -1, 0.25f}, {0.3f, 1, 0.25f}};
  const std::vector<glm::vec3> b = {{-1, -1, 0.25f}, {0.3f, 1, 0.25f}, {-1, 1, 0.25f}};
  for (const bool swapped : {false, true}) {
    std::vector<glm::vec3> both = swapped ? b : a;
    const std::vector<glm::vec3>& second = swapped ? a : b;
    both.insert(both.end(), second.begin(), second.end());
    const Emulation ours = Frame(triangles(both), 4, 16).run();
    const Emulation fine = Frame(triangles(both), 16, 0, false, coverage_positions(4, 16)).run();
    int mixed = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize / 2; ++x) {
        const float expected = fine.color.at(x, y).x, found = ours.color.at(x, y).x;
        if (expected < 1.0f) continue;  // beyond the second edge
        EXPECT_GE(found, 1.0f);
        EXPECT_LE(found, 2.0f);
        if (found == 1.0f || found == 2.0f) continue;  // one of them has no sample
        ++mixed;
        EXPECT_NEAR(found, expected, 1e-6f);
      }
    EXPECT_GT(mixed, 8);
  }
}

TEST(CoverageMap, DroppedOrphansOverrateTheLaterSurface) {
  const std::vector<glm::vec3> t = {{-1.0f, -1.0f, 0.5f}, {0.37f, -1.0f, 0.5f}, {-1.0f, 2.9f, 0.5f}};
  const Emulation follow = Frame(triangles(t), 4, 16).run(), drop = Frame(triangles(t), 4, 16, true).run();
  float more = 0.0f;
  for (std::size_t p = 0; p < follow.color.pixels.size(); ++p) {
    EXPECT_GE(drop.color.pixels[p].x, follow.color.pixels[p].x);
    more += drop.color.pixels[p].x - follow.color.pixels[p].x;
  }
  EXPECT_GT(more, 1.0f);
}

TEST(CoverageMap, CountsPositionsTestsSamplesAndMovesMaps) {
  const std::vector<glm::vec3> all = {{-1, -1, 0.5f}, {3, -1, 0.5f}, {-1, 3, 0.5f}};
  const Emulation whole = Frame(triangles(all), 4, 16).run();
  const PassCounters n = total(test::pass_named(whole.trace, "draw"));
  EXPECT_EQ(n.raster.covered_samples, 16u * kSize * kSize);
  EXPECT_EQ(n.zrop.early_z_tested_samples, 4u * kSize * kSize);
  EXPECT_EQ(n.crop.written_samples, 4u * kSize * kSize);
  EXPECT_EQ(n.mem.other_read_bytes + n.mem.other_write_bytes, 0u) << "one fragment a pixel: no map";
  const std::vector<glm::vec3> half = {{-1, -1, 0.5f}, {0.02f, -1, 0.5f}, {-1, 1, 0.5f}};
  const Emulation edge = Frame(triangles(half), 4, 16).run();
  const PassCounters m = total(test::pass_named(edge.trace, "draw"));
  EXPECT_GT(m.mem.other_write_bytes, 0u);
  EXPECT_EQ(m.mem.other_write_bytes % 6, 0u);
  EXPECT_GT(total(test::pass_named(edge.trace, "resolve")).mem.other_read_bytes, 0u);
  EXPECT_EQ(test::pass_named(edge.trace, "draw").raster_samples, 16);
}

std::string refusal(const FrameGraph& graph, int coverage_samples_max) {
  GpuFeatures features = every_feature(32);
  features.coverage_samples_max = coverage_samples_max;
  try {
    compile(graph, features, FunctionalConfig{});
  } catch (const InputError& error) {
    return error.diagnostics().front().code + " " + error.diagnostics().front().message;
  }
  return "";
}

TEST(CoverageMap, IsRefusedByTheNameOfTheSwitch) {
  const std::vector<glm::vec3> t = {{-1, -1, 0.5f}, {1, -1, 0.5f}, {-1, 1, 0.5f}};
  const Frame frame(triangles(t), 4, 16);
  EXPECT_EQ(refusal(frame.graph, 16), "");
  EXPECT_NE(refusal(frame.graph, 8).find("gpu.features.coverage_samples_max"), std::string::npos);
  EXPECT_NE(refusal(frame.graph, 0).find("this GPU has none"), std::string::npos);
  EXPECT_EQ(refusal(Frame(triangles(t), 4, 4).graph, 16).substr(0, 4), "G002");
  EXPECT_EQ(refusal(Frame(triangles(t), 4, 12).graph, 16).substr(0, 4), "G002");
  FrameGraph mixed = frame.graph;
  Pass& pass = mixed.add_pass("second", PassKind::full_screen);
  pass.color = {mixed.add_image({"copy", Format::r32_float, kSize, kSize, 1})};
  pass.fragment = &test::constant_program();
  pass.sampled = {ImageId{0}};
  EXPECT_EQ(refusal(mixed, 16).substr(0, 4), "G009") << "only a resolve reads the map";
}

}  // namespace
}  // namespace hwsim::pipeline
