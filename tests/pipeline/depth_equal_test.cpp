// A pass with the test EQUAL meets the depth that a pre-pass wrote, bit for bit, though another vertex
// program computes the position. After the pre-pass no sample of the scene is nearer than what is stored, so
// for each sample the numbers of triangles that pass LESS, EQUAL and GREATER are 0, at least 1 where
// something is visible, and the rest.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "pipeline/open/scene_source.h"
#include "support/frames.h"
#include "support/places.h"

namespace hwsim::pipeline {
namespace {

struct Counts {
  std::vector<float> passed, depth;  // one value for each sample
  std::uint64_t samples_passed = 0, killed_tiles = 0;
};

struct Setup {
  std::shared_ptr<const Scene> scene;
  int samples;
  Format format;
};

glm::mat4 camera_matrix(const Scene& scene, float aspect) {
  return clip_from_view(scene.cameras.front(), aspect) * scene.cameras.front().view_from_world;
}

/// How many triangles pass `compare` at each sample after the pre-pass, without writing.
Counts count(const Setup& setup, Compare compare) {
  constexpr int kWidth = 160, kHeight = 90;
  test::SampleFrame frame(setup.scene, kWidth, kHeight, setup.samples, Format::r32_float, setup.format);
  const glm::mat4 clip = camera_matrix(*setup.scene, static_cast<float>(kWidth) / kHeight);
  DrawBatch before = frame.all_draws(mesh_position_program(), nullptr, clip);
  before.state.depth = {true, true, Compare::less};
  before.state.raster.cull = CullMode::back;
  frame.draw("prepass", {before}, false);
  DrawBatch after = frame.all_draws(mesh_surface_program(),
                                    &test::constant_program(mesh_surface_program().varying_scalars), clip);
  after.state.depth = {true, false, compare};
  after.state.raster.cull = CullMode::back;
  after.state.blend = {{true, BlendFactor::one, BlendFactor::one, BlendFactor::one, BlendFactor::one, 0xf}};
  frame.draw("count", {after});
  const Emulation e = frame.run();
  Counts counts;
  for (const glm::vec4& sample : e.color.pixels) {
    counts.passed.push_back(sample.x);
    counts.depth.push_back(sample.y);
  }
  const PassCounters n = total(test::pass_named(e.trace, "count"));
  counts.samples_passed = n.stats.samples_passed;
  counts.killed_tiles = n.hiz.killed_tiles;
  return counts;
}

struct Figures {
  std::uint64_t visible = 0, met = 0, twice = 0;
};

void check(const Setup& setup, Figures& figures) {
  const Counts less = count(setup, Compare::less), equal = count(setup, Compare::equal);
  const Counts greater = count(setup, Compare::greater), always = count(setup, Compare::always);
  EXPECT_EQ(less.samples_passed, 0u);
  EXPECT_EQ(equal.samples_passed + greater.samples_passed, always.samples_passed);
  if (setup.samples > 1) {  // one format a scene: the others differ in the stored depth only
    EXPECT_EQ(count(setup, Compare::less_equal).passed, equal.passed);
    EXPECT_EQ(count(setup, Compare::not_equal).passed, greater.passed);
  }
  double sum = 0.0;
  std::uint64_t missed = 0, uncounted = 0;
  for (std::size_t i = 0; i < equal.passed.size(); ++i) {
    sum += equal.passed[i];
    const bool visible = always.passed[i] > 0.0f;
    figures.visible += visible ? 1 : 0;
    figures.met += equal.passed[i] > 0.0f ? 1 : 0;
    figures.twice += equal.passed[i] > 1.0f ? 1 : 0;
    missed += visible != (equal.passed[i] > 0.0f) ? 1 : 0;
    uncounted += equal.passed[i] + greater.passed[i] != always.passed[i] ? 1 : 0;
  }
  EXPECT_EQ(missed, 0u);
  EXPECT_EQ(uncounted, 0u);
  EXPECT_EQ(sum, static_cast<double>(equal.samples_passed));
}

TEST(DepthEqual, MeetsThePrePassInEverySampleOfEveryScene) {
  std::vector<std::string> scenes;
  for (const GeneratorInfo& generator : generators()) scenes.push_back(generator.name);
  for (const char* file : {"dragon_small.glb", "sponza.glb"})
    if (const std::string path = hwsim::test::shared_dir() + "/scenes/" + file; std::filesystem::exists(path))
      scenes.push_back(path);
  bool sixteen_bits = false;
  for (const std::string& name : scenes) {
    SCOPED_TRACE(name);
    sixteen_bits = !sixteen_bits;
    const auto scene = test::share(open_scene(name, hwsim::test::binary_dir() + "/test_scenes"));
    Figures figures;
    for (const Format format : {Format::d24_unorm_s8, sixteen_bits ? Format::d16_unorm : Format::d32_float}) {
      SCOPED_TRACE(info(format).name);
      check({scene, format == Format::d24_unorm_s8 ? 4 : 1, format}, figures);
    }
    EXPECT_GT(figures.visible, 1000u);
    std::printf("[     note ] %s: %llu visible samples, %llu met by EQUAL, %llu by more than one triangle\n",
                scene->name.c_str(), static_cast<unsigned long long>(figures.visible),
                static_cast<unsigned long long>(figures.met), static_cast<unsigned long long>(figures.twice));
  }
}

}  // namespace
}  // namespace hwsim::pipeline
