// Frames are emulated once: what comes from the cache is what was emulated, and damage is never believed.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/program.h"

namespace hwsim::cli::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kOwnCache = "HWSIM_CACHE=cache";

class CacheTest : public testing::Test {
 protected:
  CacheTest() {
    place.write("triangle.gltf", kTriangleGltf);
    std::this_thread::sleep_for(std::chrono::milliseconds(150));  // files just written are not trusted
  }
  json run(const std::string& flags, const std::string& environment = kOwnCache) {
    const bool sized = flags.find("--resolution") != std::string::npos;
    const Outcome outcome = place.hwsim("run triangle.gltf -t msaa4x --json --force --out result " +
                                            std::string(sized ? "" : "--resolution 64x48 ") + flags,
                                        environment);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    messages = outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }
  bool cached(const std::string& flags, const std::string& environment = kOwnCache) {
    return run(flags, environment)["emulation"]["from_cache"];
  }
  fs::path entry(const std::string& ending) const {
    for (const fs::directory_entry& file : fs::directory_iterator(place / "cache/traces"))
      if (file.path().extension() == ending) return file.path();
    return {};
  }
  Workplace place;
  std::string messages;
};

TEST_F(CacheTest, SecondRunGivesTheSameBytesWithoutEmulating) {
  EXPECT_FALSE(cached("--reference 1"));
  std::map<std::string, std::string> before;
  const std::vector<std::string> files = {"passes.csv", "counters.csv",     "color.png", "color.exr",
                                          "flip.exr",   "heat_shading.png", "trace.json"};
  for (const std::string& file : files) before[file] = place.read("result/" + file);
  EXPECT_TRUE(cached("--reference 1"));
  for (const std::string& file : files) EXPECT_TRUE(before[file] == place.read("result/" + file)) << file;
}

TEST_F(CacheTest, WhateverChangesTheWorkIsEmulatedAnew) {
  EXPECT_FALSE(cached("--no-image"));
  EXPECT_FALSE(cached("--no-image --resolution 64x49"));
  EXPECT_FALSE(cached("--no-image --lights 1"));
  EXPECT_FALSE(cached("--no-image --no-shadows"));
  EXPECT_FALSE(cached("--no-image --set technique.centroid=off"));
  EXPECT_FALSE(cached("--no-image --set gpu.features.conservative_raster=false"));
  EXPECT_FALSE(cached("--no-image --set gpu.functional.post_transform_cache_entries=3"));
  EXPECT_FALSE(cached("--no-image --set emulator.skip=none"));
  EXPECT_FALSE(cached("")) << "an image was asked for, and none is kept";
  EXPECT_TRUE(cached("--no-image"));
  std::string larger = kTriangleGltf;
  larger.replace(larger.find("AACAvwAAgL8"), 11, "AAAAwAAAgL8");  // x of a corner: -1 becomes -2
  place.write("triangle.gltf", larger);
  EXPECT_FALSE(cached("--no-image"));
}

TEST_F(CacheTest, WhatOnlyChangesTheTimeIsReplayed) {
  const double slow_ms = run("--no-image --set gpu.core_clock_mhz=500")["frame"]["time_ms"];
  const json fast = run("--no-image --set gpu.core_clock_mhz=1500 --set gpu.l2_size_kib=4096");
  EXPECT_TRUE(fast["emulation"]["from_cache"]);
  EXPECT_LT(fast["frame"]["time_ms"].get<double>(), slow_ms);
  EXPECT_TRUE(cached("--no-image --engine roofline"));
}

TEST_F(CacheTest, DamageIsNotedAndTheWorkDoneAgain) {
  run("");
  const std::string good = place.read("result/passes.csv");
  const auto expect_made_anew = [&](const std::string& what, const std::string& flags) {
    EXPECT_FALSE(cached(flags)) << what;
    EXPECT_NE(messages.find("note[K001]"), std::string::npos) << what << messages;
    EXPECT_EQ(place.read("result/passes.csv"), good) << what;
  };
  const fs::path trace = entry(".trace"), image = entry(".image");
  const auto size = fs::file_size(trace);
  for (const std::uintmax_t length : {std::uintmax_t{0}, std::uintmax_t{39}, size / 2, size - 1}) {
    fs::resize_file(trace, length);
    expect_made_anew("cut off at " + std::to_string(length), "--no-image");
    EXPECT_TRUE(cached("--no-image")) << "it was not made anew";
  }
  std::fstream(trace, std::ios::in | std::ios::out | std::ios::binary)
      .seekp(static_cast<std::streamoff>(size / 2))
      .write("~#", 2);
  expect_made_anew("bytes changed", "--no-image");
  fs::resize_file(image, fs::file_size(image) - 1);
  expect_made_anew("image cut off", "");
  EXPECT_TRUE(cached(""));
}

TEST_F(CacheTest, DamagedSummaryOfASceneIsNoted) {
  run("--no-image");
  for (const fs::directory_entry& file : fs::directory_iterator(place / "cache/scenes"))
    fs::resize_file(file.path(), fs::file_size(file.path()) - 1);
  EXPECT_TRUE(cached("--no-image"));
  EXPECT_NE(messages.find("note[K001]"), std::string::npos) << messages;
}

TEST_F(CacheTest, NoteOfTheLoaderIsRepeatedWhenNothingIsLoaded) {
  run("--no-image");
  const std::string first = messages;
  ASSERT_NE(first.find("note[S117]"), std::string::npos) << first;
  run("--no-image");
  EXPECT_NE(messages.find("note[S117]"), std::string::npos) << messages;
}

TEST_F(CacheTest, CacheThatCannotBeWrittenIsNoError) {
  place.write("file", "in the way");
  EXPECT_FALSE(cached("--no-image", "HWSIM_CACHE=file/cache"));
  EXPECT_NE(messages.find("note[K002]"), std::string::npos) << messages;
}

TEST_F(CacheTest, NoCacheNeitherReadsNorWrites) {
  EXPECT_FALSE(cached("--no-image --no-cache"));
  EXPECT_FALSE(fs::exists(place / "cache/traces"));
  run("--no-image");
  EXPECT_FALSE(cached("--no-image --no-cache"));
}

TEST_F(CacheTest, LimitRemovesTheLeastRecentlyUsed) {
  const std::string one_mib = "HWSIM_CACHE_MIB=1 HWSIM_CACHE=cache";
  run("--resolution 128x128", one_mib);  // 0.2 MiB of image each
  run("--resolution 129x128", one_mib);
  EXPECT_TRUE(cached("--resolution 128x128", one_mib));
  for (int i = 0; i < 4; ++i) run("--resolution " + std::to_string(200 + i) + "x128", one_mib);
  EXPECT_FALSE(cached("--resolution 129x128", one_mib));
  std::uintmax_t bytes = 0;
  for (const fs::directory_entry& file : fs::directory_iterator(place / "cache/traces"))
    bytes += file.file_size();
  EXPECT_LE(bytes, 1u << 20);
  EXPECT_FALSE(cached("--no-image --lights 2", "HWSIM_CACHE_MIB=0 HWSIM_CACHE=cache"));
  EXPECT_FALSE(cached("--no-image --lights 2", one_mib));
  const Outcome bad =
      place.hwsim("run triangle.gltf --no-image --lights 3", "HWSIM_CACHE_MIB=x HWSIM_CACHE=cache");
  EXPECT_EQ(bad.status, 3);
  EXPECT_NE(bad.err.find("error[U017]"), std::string::npos) << bad.err;
}

TEST_F(CacheTest, PruneKeepsAsMuchAsAskedFor) {
  run("");
  const Outcome kept = place.hwsim("cache prune --keep-mib 100 --json", kOwnCache);
  EXPECT_EQ(json::parse(kept.out).size(), 0u);
  for (const json& entry : json::parse(place.hwsim("cache list --json", kOwnCache).out)) {
    if (entry["folder"] != "traces") continue;
    EXPECT_NE(entry["entry"].get<std::string>().find(" of triangle, 64x48"), std::string::npos) << entry;
  }
  place.hwsim("cache prune --keep-mib 0", kOwnCache);
  EXPECT_EQ(json::parse(place.hwsim("cache list --json", kOwnCache).out).size(), 0u);
  EXPECT_FALSE(cached(""));
}

}  // namespace
}  // namespace hwsim::cli::test
