// Layers of eight samples under shifted viewports against one rasterization at all their positions: the same
// coverage and depth, bit for bit (docs/techniques/forward.md#multicast).
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "pipeline/state/sample_pattern.h"
#include "support/frames.h"

namespace hwsim::pipeline {
namespace {
using test::SampleFrame;

constexpr int kWidth = 75, kHeight = 50;

/// Triangles of all sizes, tilted, intersecting, over the frame's edges and through the near plane.
std::shared_ptr<const Scene> random_scene(unsigned seed, int count) {
  std::mt19937 random(seed);
  const auto next = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random() % 65536) / 65536.0f;
  };
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 center(next(-1.1f, 1.1f), next(-1.1f, 1.1f), next(0.0f, 1.0f));
    const float size = i % 3 == 0 ? 1.5f : (i % 3 == 1 ? 0.2f : 0.02f);
    for (int v = 0; v < 3; ++v) {
      indices.push_back(static_cast<std::uint32_t>(positions.size()));
      positions.push_back(center + size * glm::vec3(next(-1, 1), next(-1, 1), next(-0.3f, 0.3f)));
    }
  }
  return test::share(test::clip_space_scene(positions, indices));
}

Emulation draw(SampleFrame& frame, std::vector<SamplePosition> positions, int jobs = 1) {
  DrawBatch batch = frame.all_draws(mesh_position_program(), &test::primitive_program());
  batch.state.depth = {true, true, Compare::less};
  batch.state.raster.sample_positions = std::move(positions);
  frame.draw("draw", {batch});
  EmulationOptions options;
  options.jobs = jobs;
  return frame.run(options);
}

void compare(const std::shared_ptr<const Scene>& scene, int samples, Format depth) {
  const MulticastPattern pattern = multicast_pattern(samples);
  SampleFrame direct(scene, kWidth, kHeight, samples, Format::r32_float, depth);
  SampleFrame layered(scene, kWidth, kHeight, 8, Format::r32_float, depth, 0, pattern.viewports);
  // The standard positions of 32 samples are those of the layers; more than 16 cannot be set.
  const Emulation a =
      draw(direct, samples == 32 ? std::vector<SamplePosition>{} : effective_positions(pattern));
  const Emulation b = draw(layered, pattern.positions, 2);
  ASSERT_EQ(a.color.pixels.size(), b.color.pixels.size());
  std::size_t covered = 0;
  for (std::size_t i = 0; i < a.color.pixels.size(); ++i) {
    ASSERT_EQ(a.color.pixels[i].x, b.color.pixels[i].x) << i;
    ASSERT_EQ(a.color.pixels[i].y, b.color.pixels[i].y) << i;
    covered += a.color.pixels[i].x > 0.0f ? 1 : 0;
  }
  EXPECT_GT(covered, 20u);
}

TEST(Multicast, LayersAreOneRasterizationAtAllTheirPositions) {
  for (const int samples : {16, 32})
    for (unsigned seed = 0; seed < 6; ++seed)
      compare(random_scene(seed, 40), samples, seed % 2 == 0 ? Format::d32_float : Format::d24_unorm_s8);
}

// Vertices and primitives once, setup and rasterization once a layer.
TEST(Multicast, CountsSetupAndRasterizationForEachLayer) {
  const auto scene = test::share(test::clip_space_scene(
      {{-0.9f, -0.9f, 0.5f}, {0.9f, -0.8f, 0.5f}, {0, 0.9f, 0.5f}, {0.01f, 0.01f, 0.5f}},
      {0, 1, 2, 0, 2, 1, 0, 3, 1}));
  const MulticastPattern pattern = multicast_pattern(32);
  const auto run = [&](SampleFrame&& frame, std::vector<SamplePosition> positions) {
    DrawBatch batch = frame.all_draws(mesh_position_program(), &test::primitive_program());
    batch.state.raster.cull = CullMode::back;
    batch.state.raster.sample_positions = std::move(positions);
    frame.draw("draw", {batch});
    return total(test::pass_named(frame.run().trace, "draw"));
  };
  const PassCounters direct = run(SampleFrame(scene, kWidth, kHeight, 32), {});
  const PassCounters layered =
      run(SampleFrame(scene, kWidth, kHeight, 8, Format::r32_float, Format::d32_float, 0, pattern.viewports),
          pattern.positions);
  EXPECT_EQ(layered.stats.vertex_shader_invocations, direct.stats.vertex_shader_invocations);
  EXPECT_EQ(layered.stats.clipping_primitives, direct.stats.clipping_primitives);
  EXPECT_EQ(layered.setup.in_primitives, 4 * direct.setup.in_primitives);
  EXPECT_EQ(layered.setup.culled_backface_primitives, 4 * direct.setup.culled_backface_primitives);
  EXPECT_EQ(layered.setup.out_primitives, 4 * direct.setup.out_primitives);
  EXPECT_EQ(layered.raster.covered_samples, direct.raster.covered_samples);
  EXPECT_GT(layered.raster.fragments, direct.raster.fragments);
  EXPECT_LE(layered.raster.fragments, 4 * direct.raster.fragments);
  EXPECT_NEAR(static_cast<double>(layered.raster.visited_tiles),
              4.0 * static_cast<double>(direct.raster.visited_tiles), 8.0);
}

// 0.1 pixels beyond the frame's right edge; with the standard positions, a viewport half a pixel to the left
// sees it.
TEST(Multicast, ShiftedViewportsShowWhatLiesBeyondTheEdge) {
  const float right = 1.0f + 0.2f / kWidth;
  const auto scene = test::share(test::clip_space_scene(
      {{right, -1.0f, 0.5f}, {right + 0.5f, -1.0f, 0.5f}, {right, 1.0f, 0.5f}}, {0, 1, 2}));
  SampleFrame frame(scene, kWidth, kHeight, 8, Format::r32_float, Format::d32_float, 0, {{0, 0}, {-128, 0}});
  const Emulation e = draw(frame, {});
  for (std::size_t i = 0; i < e.color.pixels.size(); ++i) {
    const std::size_t plane = i % 16, x = i / 16 % kWidth;
    if (plane < 8 || x + 1 < kWidth) {
      ASSERT_EQ(e.color.pixels[i].x, 0.0f);
    }
  }
  double covered = 0.0;
  for (const glm::vec4& p : e.color.pixels) covered += p.x > 0.0f ? 1.0 : 0.0;
  // It begins 0.1 pixels right of the last column's centers: three of eight samples lie beyond.
  EXPECT_NEAR(covered, 3.0 * kHeight, 6.0);
}

TEST(Multicast, PatternsFillThePixelEvenly) {
  for (const int samples : {16, 32}) {
    std::set<std::pair<int, int>> distinct;
    std::array<int, 16> columns{}, rows{};
    for (const SamplePosition p : effective_positions(multicast_pattern(samples))) {
      distinct.insert({p.x, p.y});
      columns.at(static_cast<std::size_t>(p.x + 8)) += 1;
      rows.at(static_cast<std::size_t>(p.y + 8)) += 1;
    }
    EXPECT_EQ(distinct.size(), static_cast<std::size_t>(samples));
    for (std::size_t i = 0; i < 16; ++i) {
      EXPECT_EQ(columns[i], samples / 16);
      EXPECT_EQ(rows[i], samples / 16);
    }
  }
  const auto all = effective_positions(multicast_pattern(32));
  const auto standard = standard_sample_positions(32);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].x, standard[i].x);
    EXPECT_EQ(all[i].y, standard[i].y);
  }
}

// A layer shades at its pixel's center. With samples beside it, textures and shadows would move against
// edges.
TEST(Multicast, LayersShadeInTheMiddleOfWhatTheySample) {
  for (const int samples : {16, 32}) {
    const MulticastPattern pattern = multicast_pattern(samples);
    glm::ivec2 sum(0), shifts(0);
    for (const SamplePosition p : pattern.positions) sum += glm::ivec2(p.x, p.y);
    for (const ViewportShift shift : pattern.viewports) shifts += glm::ivec2(shift.x, shift.y);
    EXPECT_LE(std::abs(sum.x), 8) << samples;  // half a sixteenth of a pixel each: positions are whole
    EXPECT_LE(std::abs(sum.y), 8) << samples;
    EXPECT_LE(std::abs(shifts.x), 16) << samples;
    EXPECT_LE(std::abs(shifts.y), 16) << samples;
  }
}

// Alpha keeps the same samples, whether they lie in layers or not.
TEST(Multicast, AlphaToCoverageCountsTheSamplesOfAllLayers) {
  const MulticastPattern pattern = multicast_pattern(32);
  const auto scene =
      test::share(test::clip_space_scene({{-1, -1, 0.5f}, {3, -1, 0.5f}, {-1, 3, 0.5f}}, {0, 1, 2}));
  for (const float alpha : {0.03f, 0.2f, 0.5f, 0.77f}) {
    const auto run = [&](SampleFrame&& frame, std::vector<SamplePosition> positions) {
      DrawBatch batch = frame.all_draws(mesh_position_program(), &test::constant_program());
      batch.fragment_uniforms = std::make_shared<glm::vec4>(1.0f, 1.0f, 1.0f, alpha);
      batch.state.coverage.alpha_to_coverage = true;
      batch.state.raster.sample_positions = std::move(positions);
      frame.draw("alpha", {batch});
      return frame.run().color.pixels;
    };
    const auto native = run(SampleFrame(scene, 16, 16, 32), {});
    const auto layered =
        run(SampleFrame(scene, 16, 16, 8, Format::r32_float, Format::d32_float, 0, pattern.viewports),
            pattern.positions);
    EXPECT_EQ(native, layered);
  }
}

}  // namespace
}  // namespace hwsim::pipeline
