// A check of shapes: how cycles and bytes grow with the samples on `r600_like`, beside what an open simulator
// of that class published of one simple scene.
#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "hwsim/engines/timing.h"
#include "hwsim/gpu/gpu_config.h"
#include "support/frames.h"
#include "support/places.h"

namespace hwsim::pipeline {
namespace {
using test::SampleFrame;

constexpr int kWidth = 640, kHeight = 480;

/// 240 triangles of about 3000 pixels at random places, angles and depths: two thirds of what is drawn is
/// seen.
std::shared_ptr<const Scene> large_triangles() {
  std::mt19937 random(5);
  const auto ratio = [&random] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < 240; ++i) {
    const float x = ratio() * kWidth, y = ratio() * kHeight, z = ratio(), turn = ratio() * 6.2831853f;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const float angle = turn + 2.0943951f * static_cast<float>(k), radius = 48.0f;
      positions.emplace_back(2.0f * (x + radius * std::cos(angle)) / kWidth - 1.0f,
                             2.0f * (y + radius * std::sin(angle)) / kHeight - 1.0f,
                             0.2f + 0.6f * z + 0.05f * static_cast<float>(k));
      indices.push_back(3 * i + k);
    }
  }
  return test::share(test::clip_space_scene(positions, indices));
}

PassWork draw_large_triangles(int samples) {
  static const std::shared_ptr<const Scene> scene = large_triangles();
  SampleFrame frame(scene, kWidth, kHeight, samples, Format::rgba8_unorm, Format::d24_unorm_s8);
  DrawBatch batch = frame.all_draws(mesh_position_program(), &test::constant_program());
  batch.state.depth = {true, true, Compare::less};
  frame.draw("draw", {batch});
  return test::pass_named(frame.run().trace, "draw");
}

struct Shape {
  double ns = 0.0, color = 0.0, depth = 0.0;
};

/// `words` instruction words a pixel: what the shader of the published scene took is not known.
Shape shape_of(PassWork pass, double words, const GpuConfig& gpu) {
  for (PassCounters& c : pass.chunks) {
    c.shader.vliw5_issued_words_w64 =
        static_cast<std::uint64_t>(words * static_cast<double>(c.stats.fragment_shader_invocations));
    c.shader.alu_issued_lane_ops_w64 = 3 * c.shader.vliw5_issued_words_w64;
  }
  WorkTrace trace;
  trace.passes = {std::move(pass)};
  const PassTiming t = time_frame(trace, gpu, Engine::queue).passes[0];
  const auto bytes = [&t](Stream stream) {
    const auto i = static_cast<std::size_t>(stream);
    return t.dram_bytes.read[i] + t.dram_bytes.write[i];
  };
  return {t.time_ns - t.overhead_ns, bytes(Stream::color), bytes(Stream::depth)};
}

// docs/hardware_model.md, "A check of shapes", prints and explains the table. Bytes do not depend on the
// shader. Cycles grow with the samples where the ROPs limit, and not where the shader does: the published
// ones lie between.
TEST(MsaaShape, LargeTrianglesOnAnR600LikeGpuGrowAsPublished) {
  struct Published {
    int samples;
    double cycles, color, depth;
  };
  constexpr Published kPublished[] = {{2, 1.71, 2.10, 2.50}, {4, 2.86, 4.15, 5.05}, {8, 5.29, 8.32, 10.4}};
  constexpr double kWords[] = {0.0, 8.0, 16.0, 32.0};
  const GpuConfig gpu = load_gpu("r600_like", {}, {}, hwsim::test::source_dir() + "/configs/gpus");
  const PassWork one_sample = draw_large_triangles(1);
  for (const Published& p : kPublished) {
    const PassWork pass = draw_large_triangles(p.samples);
    std::vector<double> cycles;
    for (const double words : kWords) {
      const Shape one = shape_of(one_sample, words, gpu), shape = shape_of(pass, words, gpu);
      cycles.push_back(shape.ns / one.ns);
      EXPECT_NEAR(shape.color / one.color / p.color, 1.0, 0.03) << p.samples;
      EXPECT_NEAR(shape.depth / one.depth / p.depth, 1.0, 0.2) << p.samples;
      std::printf(
          "%dx, %2.0f words a pixel: cycles %.2f (published %.2f), color %.2f (%.2f), depth %.2f (%.2f)\n",
          p.samples, words, cycles.back(), p.cycles, shape.color / one.color, p.color,
          shape.depth / one.depth, p.depth);
    }
    EXPECT_NEAR(cycles.front() / p.samples, 1.0, 0.06);  // a ROP writes a sample a clock
    EXPECT_GT(cycles.front(), p.cycles);
    EXPECT_NEAR(cycles[1] / p.cycles, 1.0, 0.2);  // eight words: what a texture and a light take
    EXPECT_LT(cycles.back(), p.cycles);
  }
}

}  // namespace
}  // namespace hwsim::pipeline
