// Every technique on every scene: pixels are numbers, passes take time, and no counter has wrapped.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "algos/frame_run.h"
#include "hwsim/engines/timing.h"
#include "hwsim/gpu/gpu_config.h"
#include "support/places.h"

namespace hwsim::test {
namespace {

// The generators at sizes that suit a small image; one that is not listed keeps its defaults.
std::string small_spec(const std::string& name) {
  static const std::map<std::string, std::string> small = {
      {"sponza_hall", "bays=4,detail=6"},
      {"grass", "blades=2000"},
      {"powerplant", "pipes=20,grating_m=2,sides=4,levels=1"},
      {"dragon", "triangles=20000"},
      {"old_city", "length_m=10,tables=1,leaf_cards=20,slats=1,sides=3,bars_per_m=1"},
      {"foliage", "trees=3,bushes=3,tufts=30,leaf_cards=40,side_m=8"},
      {"bamboo", "culms=30,leaves=60,fallen_leaves=200,sides=4"},
      {"metal", "weave=4,sides=3,segments=6"},
      {"fur_ball", "hairs=3000,segments=3"},
      {"car_body", "triangles=25000"},
      {"grill", "bars=12,sides=6,segments=6,mesh_m=0.1,detail=2"},
      {"wires", "poles=3"},
      {"text_page", "lines=10,columns=30"}};
  const auto found = small.find(name);
  return found == small.end() ? name : name + ":" + found->second;
}

class EveryScene : public ::testing::TestWithParam<std::string> {};

void check(const std::string& technique, const std::string& scene) {
  const bool large = technique.starts_with("ssaa16x") || technique.starts_with("ssaa64x");
  const FrameSetup setup{technique, scene, large ? 32 : 96, large ? 18 : 54};
  const pipeline::Emulation e = run_frame(setup, {});
  for (const glm::vec4& p : e.color.pixels)
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(std::isfinite(p[i])) << technique << " on " << scene;
  for (const PassWork& pass : e.trace.passes) {
    const PassCounters sum = total(pass);  // values() looks into it
    for (const std::uint64_t value : values(sum))
      ASSERT_LT(value, std::uint64_t{1} << 50) << technique << " on " << scene << ", pass " << pass.name;
  }
  static const GpuConfig gpu = load_gpu("gtx980", {}, {}, source_dir() + "/configs/gpus");
  const FrameTiming time = time_frame(e.trace, gpu, Engine::queue);
  for (const PassTiming& pass : time.passes)
    ASSERT_TRUE(std::isfinite(pass.time_ns) && pass.time_ns > 0.0)
        << technique << " on " << scene << ", pass " << pass.name;
  ASSERT_EQ(check_timing(time, e.trace, gpu), std::vector<std::string>()) << technique << " on " << scene;
}

TEST_P(EveryScene, GivesFiniteNumbersWithEveryTechnique) {
  for (const algos::TechniqueInfo& technique : algos::techniques())
    check(std::string(technique.id), GetParam());
}

std::vector<std::string> all_scenes() {
  std::vector<std::string> all;
  for (const pipeline::GeneratorInfo& info : pipeline::generators()) all.push_back(small_spec(info.name));
  return all;
}

INSTANTIATE_TEST_SUITE_P(Generators, EveryScene, ::testing::ValuesIn(all_scenes()),
                         [](const auto& info) { return info.param.substr(0, info.param.find(':')); });

// Real assets, where the folder with them is at hand: one technique of each kind of path.
TEST(EveryAsset, GivesFiniteNumbers) {
  const std::filesystem::path folder = shared_dir() + "/scenes";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared scenes";
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".glb" && entry.file_size() < 6'000'000)
      files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto techniques = algos::techniques();
    check(std::string(techniques[i % techniques.size()].id), files[i]);
  }
}

}  // namespace
}  // namespace hwsim::test
