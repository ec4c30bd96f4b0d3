// Cameras that the scene does not hold.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace hwsim::cli::test {
namespace {

using nlohmann::json;

class CameraTest : public testing::Test {
 protected:
  CameraTest() { place.write("triangle.gltf", kTriangleGltf); }
  Outcome run(const std::string& flags) const {
    return place.hwsim("run triangle.gltf --resolution 64x48 --no-image --force --json " + flags);
  }
  std::uint64_t shaded(const std::string& flags) const {
    return json::parse(run(flags).out)["frame"]["shaded_samples"].get<std::uint64_t>();
  }
  Workplace place;
};

TEST_F(CameraTest, StandsAndLooksWhereItIsTold) {
  const std::uint64_t far_away = shaded("--camera-eye 0,0,8 --camera-target 0,0,0 --out a");
  const std::uint64_t near = shaded("--camera-eye 0,0,4 --camera-target 0,0,0 --out b");
  const std::uint64_t wide = shaded("--camera-eye 0,0,4 --camera-target 0,0,0 --camera-fov 90 --out c");
  EXPECT_GT(far_away, 0u);
  EXPECT_NEAR(static_cast<double>(near) / static_cast<double>(far_away), 4.0, 1.0) << "half the distance";
  EXPECT_LT(wide, near);
  EXPECT_EQ(shaded("--camera-eye 0,0,4 --camera-target 0,0,9 --out d"), 0u) << "it looks away";
}

// The camera is part of what a run is: its file repeats it, a kept trace is not another camera's.
TEST_F(CameraTest, IsPartOfTheRun) {
  const Outcome first = run("--camera-eye 0,0,4 --camera-target 0,0,0 --camera-fov 45 --out a");
  EXPECT_NE(place.read("a/run.toml").find("camera = \"eye=0,0,4 target=0,0,0 fov=45\""), std::string::npos);
  const Outcome again = place.hwsim("run a/run.toml --no-image --json --out b");
  EXPECT_EQ(json::parse(first.out)["frame"], json::parse(again.out)["frame"]);
  const std::uint64_t kept = shaded("--camera-eye 0,0,4 --camera-target 0,0,0 --camera-fov 45 --out c");
  EXPECT_EQ(kept, shaded("--camera-eye 0,0,4 --camera-target 0,0,0 --camera-fov 45 --no-cache --out d"));
  EXPECT_NE(kept, shaded("--camera-eye 0,0,5 --camera-target 0,0,0 --camera-fov 45 --out e"));
}

TEST_F(CameraTest, MistakesAreTold) {
  for (const char* flags :
       {"--camera-eye 0,0 --camera-target 0,0,0", "--camera-eye 0,0,4 --camera-target 0,0,4",
        "--camera-eye 0,0,4 --camera-target 0,0,0 --camera-fov 200",
        "--camera-eye a,b,c --camera-target 0,0,0", "--camera-eye nan,0,0 --camera-target 0,0,0",
        "--camera \"eye=0,0,4\""}) {
    const Outcome outcome = run(std::string(flags) + " --out x");
    EXPECT_TRUE(outcome.status == 2 || outcome.status == 3) << flags << outcome.status;
    EXPECT_NE(outcome.err.find("U009"), std::string::npos) << flags << outcome.err;
  }
  EXPECT_EQ(run("--camera-eye 0,0,4 --out x").status, 2) << "without a target";
  EXPECT_EQ(run("--camera 0 --camera-eye 0,0,4 --camera-target 0,0,0 --out x").status, 2) << "two cameras";
}

}  // namespace
}  // namespace hwsim::cli::test
