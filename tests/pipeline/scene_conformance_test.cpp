// The conformance set and the real scenes, where they lie beside the checkout.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "pipeline/gltf/gltf_loader.h"
#include "support/places.h"

namespace hwsim::pipeline {
namespace {

const std::string kScenes = hwsim::test::shared_dir() + "/scenes/";

struct Expectation {
  std::string file, expect, triangles;
};

std::vector<Expectation> read_expectations() {
  std::ifstream in(kScenes + "conformance/expected.tsv");
  std::vector<Expectation> out;
  std::string line;
  std::getline(in, line);  // header
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    Expectation e;
    std::getline(fields, e.file, '\t');
    std::getline(fields, e.expect, '\t');
    std::getline(fields, e.triangles, '\t');
    out.push_back(e);
  }
  return out;
}

// "loaded N" or "rejected: message"; anything else thrown fails the test by itself.
std::string outcome(const std::string& path) {
  try {
    return "loaded " + std::to_string(stats(load_gltf(path)).drawn_triangles);
  } catch (const InputError& e) {
    EXPECT_FALSE(e.diagnostics().empty());
    for (const Diagnostic& d : e.diagnostics()) EXPECT_FALSE(d.message.empty() || d.code.empty()) << path;
    return std::string("rejected: ") + e.what();
  }
}

TEST(SceneConformance, EveryRowOfTheTableEndsAsExpected) {
  const auto expectations = read_expectations();
  if (expectations.empty()) GTEST_SKIP() << "no conformance set";
  for (const Expectation& e : expectations) {
    const std::string got = outcome(kScenes + "conformance/" + e.file);
    const bool rejected = got.rfind("rejected", 0) == 0;
    if (e.expect == "reject") {
      EXPECT_TRUE(rejected) << e.file << ": " << got;
    } else if (e.expect == "load" || (!rejected && e.triangles != "-")) {
      EXPECT_EQ(got, "loaded " + e.triangles) << e.file;
    }
  }
}

struct SceneCounts {
  const char* file;
  std::uint64_t stored, drawn, mask, blend, vertices;
};

class RealScene : public testing::TestWithParam<SceneCounts> {};

TEST_P(RealScene, HasTheListedCounts) {
  const SceneCounts& want = GetParam();
  if (!std::filesystem::exists(kScenes + want.file)) GTEST_SKIP() << "no scenes";
  const Scene scene = load_gltf(kScenes + want.file);
  const SceneStats got = stats(scene);
  EXPECT_EQ(got.stored_triangles, want.stored);
  EXPECT_EQ(got.drawn_triangles, want.drawn);
  EXPECT_EQ(got.drawn_mask_triangles, want.mask);
  EXPECT_EQ(got.drawn_blend_triangles, want.blend);
  EXPECT_EQ(got.vertices, want.vertices);
  EXPECT_FALSE(scene.lights.empty());
  EXPECT_TRUE(scene.lights.front().casts_shadow);
  for (std::size_t i = 0; i < scene.textures.size(); ++i)
    EXPECT_EQ(levels_of(scene, i).back().texels.size(), 1u) << "texture " << i;
}

// The README's table beside the scenes.
INSTANTIATE_TEST_SUITE_P(Table, RealScene,
                         testing::Values(SceneCounts{"sponza.glb", 262267, 262267, 34940, 0, 184406},
                                         SceneCounts{"dragon.glb", 871414, 871414, 0, 0, 437645},
                                         SceneCounts{"dragon_small.glb", 47794, 47794, 0, 0, 22982},
                                         SceneCounts{"forest.glb", 321442, 1086124, 625738, 3316, 491871},
                                         SceneCounts{"city.glb", 125048, 430514, 49433, 2526, 139664},
                                         SceneCounts{"farm.glb", 108375, 319464, 159334, 536, 113716},
                                         SceneCounts{"car_huracan.glb", 145917, 145917, 0, 104, 115576},
                                         SceneCounts{"car_sedan.glb", 120284, 120284, 0, 8192, 63720},
                                         SceneCounts{"truck.glb", 116501, 116501, 0, 12, 59963},
                                         SceneCounts{"metal.glb", 323094, 882450, 0, 0, 209374},
                                         SceneCounts{"bamboo.glb", 56684, 1417100, 0, 0, 53811},
                                         SceneCounts{"blades.glb", 54080, 1946880, 0, 0, 28171},
                                         SceneCounts{"hair.glb", 138136, 138136, 0, 0, 142592},
                                         SceneCounts{"ship.glb", 180023, 180023, 560, 95, 233557}),
                         [](const auto& info) {
                           const std::string file = info.param.file;
                           return file.substr(0, file.find('.'));
                         });

}  // namespace
}  // namespace hwsim::pipeline
