// Points against the two triangles of each that they stand for: the same images and counts, bit for bit.
#include <gtest/gtest.h>

#include <random>

#include "support/frames.h"

namespace hwsim::pipeline {
namespace {

constexpr int kSize = 64;

/// Weights of the triangle's vertices, so that its planes, its half of the square and its z all tell.
const FragmentProgram& weights_program() {
  static const FragmentProgram program = test::make_program("weights", [](FragmentBatch& batch, const void*) {
    test::for_each_lane(batch, [&](std::size_t lane) {
      for (int c = 0; c < 4; ++c) batch.color[0][c][lane] = 1.0f;
      batch.color[0][0][lane] = 1.0f + batch.b1[lane] + 4.0f * batch.b2[lane];
    });
  });
  return program;
}

struct Center {
  int x, y;  ///< 1/256 px
  float z;
};

/// Anywhere in the view and on its edges; every fourth coordinate where samples lie on the squares' edges.
std::vector<Center> centers(int count) {
  std::mt19937 random(7);
  const auto coordinate = [&] {
    const int at = static_cast<int>(random() % (kSize * kSubpixelUnits + 1));
    return random() % 4 == 0 ? at / (kSubpixelUnits / 2) * (kSubpixelUnits / 2) : at;
  };
  std::vector<Center> all;
  for (int i = 0; i < count; ++i) {
    const int x = coordinate(), y = coordinate();
    all.push_back({x, y, static_cast<float>(random() % 64) / 64.0f});
  }
  return all;
}

glm::vec3 clip_position(int x, int y, float z) {
  constexpr float kUnits = kSize * kSubpixelUnits / 2;
  return {static_cast<float>(x) / kUnits - 1.0f, 1.0f - static_cast<float>(y) / kUnits, z};
}

struct Case {
  int samples;
  bool depth, blend;
  int half;  ///< half the size of a point, 1/256 px
};

Emulation run(const Case& c, bool points) {
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;
  for (const Center& p : centers(6000)) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    if (points) {
      positions.push_back(clip_position(p.x, p.y, p.z));
      indices.push_back(first);
      continue;
    }
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      positions.push_back(clip_position(p.x + x * c.half, p.y + y * c.half, p.z));
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + i);
  }
  test::SampleFrame frame(test::share(test::clip_space_scene(std::move(positions), std::move(indices))),
                          kSize, kSize, c.samples);
  DrawBatch batch = frame.all_draws(mesh_position_program(), &weights_program());
  if (points) batch.state.raster.topology = Topology::points;
  batch.state.raster.primitive_size_px = static_cast<float>(2 * c.half) / kSubpixelUnits;
  batch.state.depth = {c.depth, c.depth, Compare::less_equal};
  if (c.blend)
    batch.state.blend = {{true, BlendFactor::one, BlendFactor::one, BlendFactor::one, BlendFactor::one, 0xf}};
  Pass& pass = frame.draw("draw", {batch});
  if (!c.depth) pass.depth = {};
  EmulationOptions options;
  options.jobs = 2;
  return frame.run(options);
}

TEST(Points, EqualTheTrianglesOfTheirSquares) {
  constexpr int kPixel = kSubpixelUnits / 2;
  for (const Case& c : {Case{1, false, true, kPixel}, Case{1, false, false, kPixel},
                        Case{1, true, false, kPixel}, Case{4, false, true, kPixel},
                        Case{8, true, false, kPixel}, Case{1, false, true, 320}, Case{1, false, true, 60}}) {
    SCOPED_TRACE(testing::Message() << c.samples << " samples, depth " << c.depth << ", blend " << c.blend
                                    << ", half " << c.half);
    const Emulation points = run(c, true), triangles = run(c, false);
    for (std::size_t i = 0; i < points.color.pixels.size(); ++i)
      ASSERT_EQ(points.color.pixels[i], triangles.color.pixels[i]) << i;
    const PassCounters a = total(test::pass_named(points.trace, "draw")),
                       b = total(test::pass_named(triangles.trace, "draw"));
    for (std::size_t i = 0; i < kCounterCount; ++i) {
      const std::string_view unit = counter_catalog()[i].unit;
      if (unit == "setup" || unit == "raster" || unit == "hiz" || unit == "ps" || unit == "shader") {
        EXPECT_EQ(values(a)[i], values(b)[i]) << counter_catalog()[i].id;
      }
    }
    EXPECT_EQ(a.stats.samples_passed, b.stats.samples_passed);
    EXPECT_EQ(a.crop.written_samples, b.crop.written_samples);
    EXPECT_GT(a.raster.fragments, 1000u);
  }
}

}  // namespace
}  // namespace hwsim::pipeline
