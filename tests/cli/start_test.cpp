// What makes the program start fast, asserted as causes: libraries that are loaded, files that are read,
// memory that is allocated. Milliseconds are measured by benchmarks/start_benchmark.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "cli/witnessed.h"
#include "support/places.h"

namespace hwsim::cli::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kOwnCache = "HWSIM_CACHE=cache";

/// The image library brings 262 others, 0.2 s.
void expect_no_image_library(const Witnessed& seen) {
  EXPECT_EQ(seen.linked.size(), seen.loaded.size()) << "something was loaded after the start";
  EXPECT_EQ(Witnessed::count(seen.loaded, "OpenImageIO"), 0u);
  EXPECT_EQ(Witnessed::count(seen.loaded, "hwsim_image_io"), 0u);
  EXPECT_LT(seen.linked.size(), 60u) << "each library takes the loader a fraction of a millisecond";
}

class StartTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_witness()) GTEST_SKIP() << "sanitizers have an allocator of their own";
  }
  Witnessed seen(const std::string& arguments) {
    Witnessed result = watch(place, arguments, kOwnCache);
    EXPECT_EQ(result.outcome.status, 0) << result.outcome.err;
    return result;
  }
  Workplace place;
};

TEST_F(StartTest, HelpReadsNoFileAndLoadsNothing) {
  for (const char* command : {"--help", "run --help", "sweep --help", "--version"}) {
    SCOPED_TRACE(command);
    const Witnessed help = seen(command);
    expect_no_image_library(help);
    EXPECT_EQ(Witnessed::count(help.read, hwsim::test::source_dir()), 0u);
    EXPECT_EQ(Witnessed::count(help.read, "cache"), 0u);
    EXPECT_TRUE(help.written.empty()) << help.written.front();
    EXPECT_LT(help.allocations, 20'000u);  // 8,763 when this was written
    EXPECT_LT(help.allocated_bytes, 4u << 20);
  }
}

TEST_F(StartTest, ReplayReadsTheWorkAndNotTheScene) {
  const std::string command =
      "run sponza_hall --resolution 320x180 -t msaa8x --no-image --force --out result";
  const Witnessed first = seen(command);
  EXPECT_GT(Witnessed::count(first.written, ".glb"), 0u) << "the witness does not see the scene";
  seen(command);  // the first run wrote the scene's file, and a file just written is not trusted yet
  const Witnessed replay = seen(command);
  expect_no_image_library(replay);
  EXPECT_EQ(Witnessed::count(replay.read, ".glb"), 0u) << "the scene was loaded";
  EXPECT_EQ(Witnessed::count(replay.read, ".trace"), 1u);
  EXPECT_EQ(Witnessed::count(replay.read, ".image"), 0u);
  EXPECT_LE(Witnessed::count(replay.read, "calibration.json"), 1u);
  EXPECT_LE(Witnessed::count(replay.read, "gtx980.toml"), 2u);  // the GPU's own file and its calibrated one
  for (const char* kept : {"cache/traces", "cache/scenes"})
    EXPECT_EQ(Witnessed::count(replay.written, kept), 0u) << "something in " << kept << " was made anew";
  EXPECT_LT(replay.allocations, 140'000u);  // 68,301 when this was written
  EXPECT_LT(replay.allocated_bytes, 32u << 20);
  EXPECT_GT(first.allocated_bytes, 32u << 20) << "the limits would not notice an emulation";
}

// Its textures are plain PNGs, as are the pictures of the frame.
TEST_F(StartTest, PicturesOfAGeneratedSceneNeedNoImageLibrary) {
  const std::string command = "run sponza_hall --resolution 64x36 -t none --force --out result";
  const Witnessed first = seen(command);
  EXPECT_GT(Witnessed::count(first.written, "color.exr"), 0u) << "the witness does not see the pictures";
  for (const Witnessed& run : {first, seen(command)})
    for (const char* library : {"OpenImageIO", "hwsim_image_io"})
      EXPECT_EQ(Witnessed::count(run.loaded, library), 0u) << library;
  const Witnessed doctor = seen("doctor");  // decodes a picture by it
  EXPECT_GT(Witnessed::count(doctor.loaded, "hwsim_image_io"), 0u) << "the witness does not see the library";
}

TEST_F(StartTest, SweepOfAThousandConfigurationsEmulatesOnce) {
  place.write("triangle.gltf", kTriangleGltf);
  const Witnessed sweep = seen(
      "sweep triangle.gltf -t msaa4x --resolution 64x48 --vary gpu.core_clock_mhz=500..2000:1000 -q --format "
      "csv");
  std::size_t lines = 0;
  for (const char c : sweep.outcome.out) lines += c == '\n' ? 1 : 0;
  EXPECT_EQ(lines, 1001u);
  EXPECT_EQ(Witnessed::count(sweep.written, ".trace"), 1u);
  EXPECT_LE(Witnessed::count(sweep.read, "triangle.gltf"), 3u);
}

}  // namespace
}  // namespace hwsim::cli::test
