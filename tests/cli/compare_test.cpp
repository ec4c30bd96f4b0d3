// Before and after, pass by pass.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace hwsim::cli::test {
namespace {

using nlohmann::json;

class CompareTest : public testing::Test {
 protected:
  CompareTest() { place.write("triangle.gltf", kTriangleGltf); }
  json compare(const std::string& flags) {
    const Outcome outcome = place.hwsim("compare triangle.gltf --resolution 64x48 --json " + flags);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }
  Workplace place;
};

TEST_F(CompareTest, DeltaIsNewMinusOldOverOld) {
  const json result = compare("-t msaa4x --set gpu.core_clock_mhz=x0.5");
  ASSERT_EQ(result["results"].size(), 1u);
  const json& time = result["results"][0]["frame"]["time_ms"];
  const double before = time["before"], after = time["after"];
  EXPECT_GT(after, before);
  EXPECT_DOUBLE_EQ(time["delta_ratio"], (after - before) / before);
  double sum = 0.0;
  for (const json& pass : result["results"][0]["passes"]) sum += pass["time_ms"]["after"].get<double>();
  EXPECT_NEAR(sum, after, 1e-9 * after);
  EXPECT_EQ(result["results"][0]["frame"]["shaded_samples"]["delta_ratio"], 0.0);
}

TEST_F(CompareTest, EveryWhatIfIsAResultOfItsOwn) {
  const json result = compare("--what-if rops-x2,infinite-dram+perfect-l2 --set gpu.core_clock_mhz=900");
  ASSERT_EQ(result["results"].size(), 3u);
  EXPECT_EQ(result["results"][0]["label"], "gpu.core_clock_mhz=900");
  EXPECT_EQ(result["results"][1]["label"], "rops-x2");
  EXPECT_EQ(result["results"][2]["label"], "infinite-dram+perfect-l2");
  for (size_t i = 1; i < 3; ++i) EXPECT_LE(result["results"][i]["frame"]["time_ms"]["delta_ratio"], 0.0);
}

// Every overlay that ships loads on a GPU and can be compared; those that only change timing change no count.
TEST_F(CompareTest, EveryOverlayThatShipsCanBeCompared) {
  const json overlays = json::parse(place.hwsim("list overlays --json").out);
  EXPECT_GE(overlays.size(), 10u);
  std::string names;
  for (const json& overlay : overlays) {
    EXPECT_FALSE(overlay["about"].get<std::string>().empty()) << overlay;
    EXPECT_FALSE(overlay["changes"].get<std::string>().empty()) << overlay;
    names += (names.empty() ? "" : ",") + overlay["name"].get<std::string>();
  }
  EXPECT_EQ(compare("-t msaa4x --what-if " + names)["results"].size(), overlays.size());
}

TEST_F(CompareTest, VariesOverRangesAndLists) {
  EXPECT_EQ(
      compare("--vary gpu.l2_size_kib=256..1024:3:log --vary gpu.core_clock_mhz=500,1000")["results"].size(),
      6u);
  const json zipped =
      compare("--vary gpu.l2_size_kib=256..1024:3:log --vary gpu.core_clock_mhz=500..1500:3 --zip");
  ASSERT_EQ(zipped["results"].size(), 3u);
  EXPECT_EQ(zipped["results"][1]["label"], "gpu.l2_size_kib=512 gpu.core_clock_mhz=1000");
}

TEST_F(CompareTest, PassesOfTwoTechniquesAreMatchedByName) {
  const json result = compare("-t none,msaa4x");
  ASSERT_EQ(result["results"].size(), 1u);
  bool has_resolve = false;
  for (const json& pass : result["results"][0]["passes"])
    if (pass["name"] == "resolve") {
      has_resolve = true;
      EXPECT_EQ(pass["limiter"]["before"], nullptr);
      EXPECT_EQ(pass["time_ms"]["before"], 0.0);
      EXPECT_EQ(pass["time_ms"]["delta_ratio"], nullptr);
    }
  EXPECT_TRUE(has_resolve);
}

TEST_F(CompareTest, FoldersOfResultsGiveTheSameAsRunningThem) {
  const std::string run = "run triangle.gltf --resolution 64x48 --no-image -t msaa4x ";
  ASSERT_EQ(place.hwsim(run + "--out a").status, 0);
  ASSERT_EQ(place.hwsim(run + "--set gpu.l2_size_kib=x2 --out b").status, 0);
  const Outcome folders = place.hwsim("compare a b --json");
  ASSERT_EQ(folders.status, 0) << folders.err;
  const json read = json::parse(folders.out), made = compare("-t msaa4x --set gpu.l2_size_kib=x2");
  EXPECT_EQ(read["results"][0]["label"], "b");
  for (const char* key : {"frame", "passes"})
    EXPECT_EQ(read["results"][0][key], made["results"][0][key]) << key;
}

TEST_F(CompareTest, CountersThatChangedAreShown) {
  const Outcome outcome = place.hwsim(
      "compare triangle.gltf --resolution 64x48 --counters --set "
      "gpu.functional.post_transform_cache_entries=0 --lights 2 --set scene.shadow_map_px=64");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("raster.visited_tiles"), std::string::npos) << outcome.out;
}

TEST_F(CompareTest, RefusesWhatItCannotCompare) {
  const auto refused = [&](const std::string& arguments, int status, const std::string& code) {
    const Outcome outcome = place.hwsim("compare " + arguments);
    EXPECT_EQ(outcome.status, status) << arguments;
    EXPECT_NE(outcome.err.find("error[" + code + "]"), std::string::npos) << arguments << outcome.err;
    EXPECT_EQ(outcome.err.find("X001"), std::string::npos) << outcome.err;
  };
  place.write("broken.json", "{\"frame\": 3}");
  place.write("cut.json", "{\"frame\": ");
  refused("triangle.gltf", 2, "U002");
  refused("triangle.gltf triangle.gltf", 2, "U004");
  refused("broken.json cut.json", 3, "U020");
  refused("broken.json triangle.gltf", 3, "U020");
  refused(".", 3, "U020");
  refused("triangle.gltf --what-if rops-x3", 3, "U018");
  refused("triangle.gltf --overlay rops", 3, "U018");
  refused("triangle.gltf --vary gpu.l2_size_kib", 3, "C020");
  refused("triangle.gltf --vary gpu.l2_size_kib=1..", 2, "U019");
  refused("triangle.gltf --vary gpu.l2_size_kib=5..1:3", 2, "U019");
  refused("triangle.gltf --vary gpu.l2_size_kib=0..4:3:log", 2, "U019");
  refused("triangle.gltf --vary gpu.l2_size_kib=1..4:1", 2, "U019");
  refused("triangle.gltf --vary gpu.l2_size_kib=1..4:3:cubic", 2, "U019");
  refused("triangle.gltf --vary gpu.l2_size_kib=1..4", 2, "U019");
  refused("triangle.gltf --vary gpu.l2_size_kib=1,,4", 2, "U019");
  refused("triangle.gltf --vary gpu.l2_size_kib=1,2 --vary gpu.l2_size_kib=3,4", 2, "U019");
  refused("triangle.gltf --zip --vary gpu.l2_size_kib=1,2 --vary gpu.core_clock_mhz=3,4,5", 2, "U019");
  refused("triangle.gltf --vary gpu.l2_size_kb=1,2", 3, "C012");
  refused("triangle.gltf --set gpu.core_clock_mhz=x-1", 3, "C014");
  refused("triangle.gltf --set gpu.queue_packets=x0.3", 3, "C013");
}

}  // namespace
}  // namespace hwsim::cli::test
