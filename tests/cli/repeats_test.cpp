// A word that stands twice in a list is one point, not two of one folder.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace hwsim::cli::test {
namespace {

using nlohmann::json;

class RepeatsTest : public testing::Test {
 protected:
  RepeatsTest() { place.write("triangle.gltf", kTriangleGltf); }

  /// The answer with each repeated word is that without, and says so once.
  void expect_same(const std::string& once, const std::string& repeated, const std::string& told) {
    const std::string flags = " --resolution 64x48 --format csv ";
    const Outcome first = place.hwsim(once + flags), again = place.hwsim(repeated + flags);
    EXPECT_EQ(first.status + again.status, 0) << repeated << first.err << again.err;
    EXPECT_EQ(again.out, first.out) << repeated;
    EXPECT_EQ(first.err.find("U024"), std::string::npos) << first.err;
    const std::size_t at = again.err.find("note[U024]: named more than once, and taken once: " + told);
    EXPECT_NE(at, std::string::npos) << repeated << again.err;
    EXPECT_EQ(again.err.find("U024", at + 6), std::string::npos) << "one note: " << again.err;
  }
  Workplace place;
};

TEST_F(RepeatsTest, PointsAreThereOnce) {
  const std::string scene = " triangle.gltf --no-image ";
  expect_same("run" + scene + "-t none,msaa4x", "run" + scene + "-t none,msaa4x,none -t none", "`none`\n");
  expect_same("run" + scene + "-g gtx980,gtx470", "run" + scene + "-g gtx980,gtx470,gtx980", "`gtx980`\n");
  expect_same("run" + scene + "-t none -g gtx980", "run" + scene + "-t none,none -g gtx980,gtx980",
              "`gtx980`, `none`\n");
  expect_same("explain triangle.gltf -t none", "explain triangle.gltf -t none,none", "`none`\n");
}

TEST_F(RepeatsTest, TechniqueWithItsDefaultsSpelledOutIsTheSame) {
  const std::string run = "run triangle.gltf --no-image -t ";
  expect_same(run + "ssaa16x", run + "ssaa16x,ssaa16x:variant=ordered", "`ssaa16x:variant=ordered`\n");
}

TEST_F(RepeatsTest, VariationsAreThereOnce) {
  expect_same("compare triangle.gltf --what-if rops-x2", "compare triangle.gltf --what-if rops-x2,rops-x2",
              "`rops-x2`\n");
  const std::string sweep = "sweep triangle.gltf --force --vary gpu.core_clock_mhz=";
  expect_same(sweep + "500,1000 --rows", sweep + "500,1000,500 --rows", "`500`\n");
}

TEST_F(RepeatsTest, PairsStayPairs) {
  const Outcome outcome = place.hwsim(
      "sweep triangle.gltf --resolution 64x48 --zip --vary gpu.core_clock_mhz=500,500 --vary "
      "gpu.l2_size_kib=512,1024 --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out).size(), 2u);
}

TEST_F(RepeatsTest, ManyAreAsQuickAsOne) {
  std::string words = "none";
  for (int i = 0; i < 20'000; ++i) words += ",none";
  expect_same("run triangle.gltf --no-image -t none", "run triangle.gltf --no-image -t " + words, "`none`\n");
}

}  // namespace
}  // namespace hwsim::cli::test
