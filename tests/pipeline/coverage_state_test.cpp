// Coverage between rasterizer, shader and color: mixed samples, coverage after depth, masks, alpha.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "support/frames.h"

namespace hwsim::pipeline {
namespace {
using test::SampleFrame;

constexpr int kSize = 24;
const BlendState kAdd{true, BlendFactor::one, BlendFactor::one, BlendFactor::one, BlendFactor::one, 0xf};

std::vector<glm::vec3> random_triangles(unsigned seed, int count) {
  std::mt19937 random(seed);
  const auto next = [&] { return static_cast<float>(random() % 2401) / 1000.0f - 1.2f; };
  std::vector<glm::vec3> positions;
  for (int i = 0; i < count; ++i) {
    const float z = static_cast<float>(random() % 1000) / 1000.0f;
    for (int v = 0; v < 3; ++v) positions.emplace_back(next(), next(), z);
  }
  return positions;
}

std::shared_ptr<const Scene> triangles(const std::vector<glm::vec3>& positions) {
  std::vector<std::uint32_t> indices(positions.size());
  for (std::uint32_t i = 0; i < indices.size(); ++i) indices[i] = i;
  return test::share(test::clip_space_scene(positions, indices));
}

std::vector<glm::vec3> rectangle(float left, float right, float z) {
  return {{left, -1, z}, {right, -1, z}, {right, 1, z}, {left, -1, z}, {right, 1, z}, {left, 1, z}};
}

/// Covered samples of one triangle (or rectangle) alone: [y * width * samples + x * samples + s].
std::vector<bool> covered(const std::vector<glm::vec3>& positions, int samples) {
  SampleFrame frame(triangles(positions), kSize, kSize, samples);
  frame.draw("alone", {frame.all_draws(mesh_position_program(), &test::constant_program())});
  std::vector<bool> out;
  for (const glm::vec4& p : frame.run().color.pixels) out.push_back(p.x > 0.0f);
  return out;
}

TEST(MixedSamples, AColorSampleIsWrittenIffOneOfItsRasterSamplesIs) {
  const std::vector<glm::vec3> positions = random_triangles(5, 30);
  std::vector<std::vector<bool>> alone;
  for (std::size_t i = 0; i < positions.size(); i += 3)
    alone.push_back(covered({positions[i], positions[i + 1], positions[i + 2]}, 8));
  for (const int color_samples : {1, 2, 4}) {
    for (const bool blended : {true, false}) {
      SampleFrame frame(triangles(positions), kSize, kSize, 8, Format::r32_float, Format::d32_float,
                        color_samples);
      DrawBatch batch = frame.all_draws(mesh_position_program(),
                                        blended ? &test::constant_program() : &test::primitive_program());
      if (blended) batch.state.blend = {kAdd};
      frame.draw("mixed", {batch});
      const Emulation e = frame.run();
      const auto ratio = static_cast<std::size_t>(8 / color_samples);
      std::uint64_t written = 0;
      for (std::size_t i = 0; i < e.color.pixels.size(); ++i) {
        const std::size_t first = i / ratio * ratio;
        float expected = 0.0f;
        for (std::size_t t = 0; t < alone.size(); ++t) {
          bool any = false;
          for (std::size_t s = first; s < first + ratio; ++s) any = any || alone[t][s];
          if (any) expected = blended ? expected + 1.0f : static_cast<float>(t + 1);
          written += any && i == first ? 1 : 0;
        }
        ASSERT_EQ(e.color.pixels[i].x, expected) << i;
      }
      EXPECT_EQ(total(test::pass_named(e.trace, "mixed")).crop.written_samples, written);
    }
  }
}

/// Red: the coverage that the shader sees, plus one.
const FragmentProgram& coverage_program() {
  static const FragmentProgram program = [] {
    FragmentProgram p = test::make_program("coverage", [](FragmentBatch& batch, const void*) {
      test::for_each_lane(batch, [&](std::size_t lane) {
        for (int c = 0; c < 4; ++c) batch.color[0][c][lane] = 0.0f;
        batch.color[0][0][lane] = static_cast<float>(batch.coverage[lane] + 1);
      });
    });
    p.reads_coverage = true;
    return p;
  }();
  return program;
}

void check_coverage_seen(bool post_depth, float near_right) {
  std::mt19937 random(9);
  const std::vector<glm::vec3> near = rectangle(-1.0f, near_right, 0.25f);
  const std::vector<bool> hidden = covered(near, 8);
  for (unsigned seed = 0; seed < 4; ++seed) {
    std::vector<glm::vec3> far = random_triangles(seed, 1);
    for (glm::vec3& p : far) p.z = 0.5f;
    const std::vector<bool> primitive = covered(far, 8);
    std::vector<glm::vec3> all = near;
    all.insert(all.end(), far.begin(), far.end());
    Scene scene = test::clip_space_scene(all, {0, 1, 2, 3, 4, 5, 6, 7, 8});
    scene.meshes[0].parts = {{0, 6, 0}, {6, 3, 0}};
    SampleFrame frame(test::share(std::move(scene)), kSize, kSize, 8);
    DrawBatch first = frame.all_draws(mesh_position_program(), nullptr);
    first.draws = {{0, 0}};
    first.state.depth = {true, true, Compare::less};
    frame.draw("near", {first}, false);
    DrawBatch second = frame.all_draws(mesh_position_program(), &coverage_program());
    second.draws = {{0, 1}};
    second.state.depth = {true, true, Compare::less};
    second.state.force_early_z = true;
    second.state.coverage.post_depth = post_depth;
    frame.draw("far", {second});
    const Emulation e = frame.run();
    for (std::size_t pixel = 0; pixel < primitive.size() / 8; ++pixel) {
      std::uint32_t mask = 0, left = 0;
      for (std::size_t s = 0; s < 8; ++s) {
        mask |= (primitive[8 * pixel + s] ? 1u : 0u) << s;
        left |= (primitive[8 * pixel + s] && !hidden[8 * pixel + s] ? 1u : 0u) << s;
      }
      for (std::size_t s = 0; s < 8; ++s) {
        const float expected =
            (left >> s & 1) != 0 ? static_cast<float>((post_depth ? left : mask) + 1) : 0.0f;
        ASSERT_EQ(e.color.pixels[8 * pixel + s].x, expected) << pixel << " " << s;
      }
    }
  }
}

TEST(PostDepthCoverage, IsWhatTheEarlyTestLeft) {
  check_coverage_seen(true, 0.03f);
  check_coverage_seen(true, -0.61f);
}
TEST(PostDepthCoverage, WithoutItShadersSeeThePrimitivesCoverage) {
  check_coverage_seen(false, 0.03f);
  check_coverage_seen(false, -0.61f);
}

/// Red 1; the mask is uniforms' integer.
const FragmentProgram& mask_program() {
  static const FragmentProgram program = [] {
    FragmentProgram p = test::make_program("mask", [](FragmentBatch& batch, const void* u) {
      test::for_each_lane(batch, [&](std::size_t lane) {
        for (int c = 0; c < 4; ++c) batch.color[0][c][lane] = 1.0f;
        batch.output_mask[lane] = *static_cast<const std::uint32_t*>(u);
      });
    });
    p.writes_mask = true;
    return p;
  }();
  return program;
}

TEST(SampleMask, IsAndedWithCoverageAndKeepsTheOthersFromDepth) {
  const std::vector<glm::vec3> shape = random_triangles(3, 1);
  const std::vector<bool> alone = covered(shape, 8);
  SampleFrame frame(triangles(shape), kSize, kSize, 8);
  DrawBatch batch = frame.all_draws(mesh_position_program(), &mask_program());
  batch.fragment_uniforms = std::make_shared<std::uint32_t>(0xa5u);
  batch.state.depth = {true, true, Compare::less};
  frame.draw("mask", {batch});
  const Emulation e = frame.run();
  for (std::size_t i = 0; i < alone.size(); ++i) {
    const bool written = alone[i] && (0xa5u >> (i % 8) & 1) != 0;
    ASSERT_EQ(e.color.pixels[i].x, written ? 1.0f : 0.0f);
    ASSERT_EQ(e.color.pixels[i].y < 1.0f, written);
  }
}

TEST(SampleMask, ReplacesCoverageWhereAskedTo) {
  const std::vector<glm::vec3> shape = random_triangles(4, 1);
  const std::vector<bool> alone = covered(shape, 8);
  for (const int color_samples : {8, 2}) {
    SampleFrame frame(triangles(shape), kSize, kSize, 8, Format::r32_float, Format::d32_float, color_samples);
    DrawBatch batch = frame.all_draws(mesh_position_program(), &mask_program());
    batch.fragment_uniforms = std::make_shared<std::uint32_t>(0xf0u);
    batch.state.depth = {true, true, Compare::less};
    batch.state.force_early_z = true;
    batch.state.coverage.override_output = true;
    frame.draw("override", {batch});
    const Emulation e = frame.run();
    std::size_t fragments = 0;
    for (std::size_t i = 0; i < alone.size(); ++i) {
      bool fragment = false;
      for (std::size_t s = i / 8 * 8; s < i / 8 * 8 + 8; ++s) fragment = fragment || alone[s];
      ASSERT_EQ(e.color.pixels[i].x, fragment && i % 8 >= 4 ? 1.0f : 0.0f) << i;
      ASSERT_EQ(e.color.pixels[i].y < 1.0f, alone[i]);  // the early test knows nothing of it
      fragments += fragment && i % 8 == 0 ? 1 : 0;
    }
    EXPECT_EQ(total(test::pass_named(e.trace, "override")).raster.fragments, fragments);
  }
}

struct AlphaResult {
  std::vector<glm::vec4> samples;
  PassCounters counters;
};

AlphaResult draw_alpha(float alpha, int samples, bool dither, bool hide = false) {
  std::vector<glm::vec3> positions = {{-1, -1, 0.5f}, {3, -1, 0.5f}, {-1, 3, 0.5f}};
  const std::vector<glm::vec3> near = rectangle(-1, 0, 0.25f);
  positions.insert(positions.end(), near.begin(), near.end());
  Scene scene = test::clip_space_scene(positions, {0, 1, 2, 3, 4, 5, 6, 7, 8});
  scene.meshes[0].parts = {{0, 3, 0}, {3, 6, 0}};
  SampleFrame frame(test::share(std::move(scene)), kSize, kSize, samples);
  DrawBatch first = frame.all_draws(mesh_position_program(), nullptr);
  first.draws = {{0, 1}};
  first.state.depth = {true, true, Compare::less};
  if (hide) frame.draw("near", {first}, false);
  DrawBatch batch = frame.all_draws(mesh_position_program(), &test::constant_program());
  batch.draws = {{0, 0}};
  batch.fragment_uniforms = std::make_shared<glm::vec4>(1.0f, 1.0f, 1.0f, alpha);
  batch.state.depth = {true, true, Compare::less};
  batch.state.coverage.alpha_to_coverage = true;
  batch.state.coverage.alpha_dither = dither;
  frame.draw("alpha", {batch});
  const Emulation e = frame.run();
  return {e.color.pixels, total(test::pass_named(e.trace, "alpha"))};
}

TEST(AlphaToCoverage, KeepsTheShareThatAlphaSaysAndWritesDepthOnlyThere) {
  for (const int samples : {4, 8, 16, 32}) {
    for (int step = -1; step <= 21; ++step) {
      const float alpha = static_cast<float>(step) / 20.0f;
      for (const bool dither : {true, false}) {
        const AlphaResult r = draw_alpha(alpha, samples, dither);
        double kept = 0.0;
        for (const glm::vec4& s : r.samples) {
          kept += s.x;
          ASSERT_EQ(s.y<1.0f, s.x> 0.0f);
        }
        const double mean = kept / static_cast<double>(r.samples.size());
        const double share = std::clamp(static_cast<double>(alpha), 0.0, 1.0);
        // 2x2 offsets round four times as finely.
        EXPECT_NEAR(mean, share, (dither ? 0.125 : 0.5) / samples + 1e-6) << alpha << " " << samples;
        EXPECT_EQ(r.counters.stats.samples_passed, static_cast<std::uint64_t>(kept));
      }
    }
  }
}

TEST(AlphaToCoverage, MasksAreNestedAndEmptyForNoNumber) {
  for (const int samples : {8, 32}) {
    AlphaResult less = draw_alpha(std::numeric_limits<float>::quiet_NaN(), samples, true);
    for (const glm::vec4& s : less.samples) ASSERT_EQ(s.x, 0.0f);
    for (int step = 1; step <= 16; ++step) {
      const AlphaResult more = draw_alpha(static_cast<float>(step) / 16.0f, samples, true);
      for (std::size_t i = 0; i < more.samples.size(); ++i) ASSERT_GE(more.samples[i].x, less.samples[i].x);
      less = more;
    }
    for (const glm::vec4& s : less.samples) ASSERT_EQ(s.x, 1.0f);
  }
}

TEST(AlphaToCoverage, HiddenFragmentsAreRejectedBeforeTheShader) {
  const AlphaResult r = draw_alpha(0.5f, 8, true, true);
  constexpr std::uint64_t kVisible = kSize * kSize / 2;
  EXPECT_EQ(r.counters.ps.invocations, kVisible);
  EXPECT_EQ(r.counters.zrop.late_z_tested_samples, kVisible * 4);
  EXPECT_EQ(r.counters.stats.samples_passed, kVisible * 4);
  for (std::size_t i = 0; i < r.samples.size(); ++i) {
    const bool hidden = i / 8 % kSize < kSize / 2;
    ASSERT_TRUE(!hidden || (r.samples[i].x == 0.0f && r.samples[i].y == 0.25f));
  }
}

/// Red: the weight of vertex 1 where attributes are taken.
const FragmentProgram& location_program() {
  static const FragmentProgram program =
      test::make_program("location", [](FragmentBatch& batch, const void*) {
        test::for_each_lane(batch, [&](std::size_t lane) {
          for (int c = 0; c < 4; ++c) batch.color[0][c][lane] = 0.0f;
          batch.color[0][0][lane] = batch.b1[lane];
        });
      });
  return program;
}

// One triangle over the whole frame, half of each pixel hidden: it still covers all samples, so its centers
// are what is shaded.
TEST(Centroid, IsThePrimitivesNotMovedByDepth) {
  std::vector<glm::vec3> positions;
  for (int i = 0; i < kSize; ++i) {
    const float left = 2.0f * static_cast<float>(i) / kSize - 1.0f;
    for (const glm::vec3& p : rectangle(left, left + 1.0f / kSize, 0.25f)) positions.push_back(p);
  }
  const auto near_count = static_cast<std::uint32_t>(positions.size());
  for (const glm::vec3& p : {glm::vec3(-1, -1, 0.5f), glm::vec3(3, -1, 0.5f), glm::vec3(-1, 3, 0.5f)})
    positions.push_back(p);
  std::vector<std::uint32_t> indices(positions.size());
  for (std::uint32_t i = 0; i < indices.size(); ++i) indices[i] = i;
  Scene scene = test::clip_space_scene(positions, indices);
  scene.meshes[0].parts = {{0, near_count, 0}, {near_count, 3, 0}};
  SampleFrame frame(test::share(std::move(scene)), kSize, kSize, 8);
  DrawBatch first = frame.all_draws(mesh_position_program(), nullptr);
  first.draws = {{0, 0}};
  first.state.depth = {true, true, Compare::less};
  frame.draw("near", {first}, false);
  DrawBatch second = frame.all_draws(mesh_position_program(), &location_program());
  second.draws = {{0, 1}};
  second.state.depth = {true, true, Compare::less};
  second.state.raster.centroid = true;
  frame.draw("far", {second});
  const Emulation e = frame.run();
  int shaded = 0;
  for (std::size_t i = 0; i < e.color.pixels.size(); ++i) {
    if (e.color.pixels[i].x == 0.0f) continue;
    const auto x = static_cast<float>(i / 8 % kSize) + 0.5f;
    ASSERT_NEAR(e.color.pixels[i].x, x / (2.0f * kSize), 1e-6f);
    ++shaded;
  }
  EXPECT_EQ(shaded, 4 * kSize * kSize);
}

}  // namespace
}  // namespace hwsim::pipeline
