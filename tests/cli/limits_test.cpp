// What the system refuses or ends: memory, file sizes, signals. The exit status is a documented one, and
// nothing half stays (docs/results.md#exit-status).
#include <gtest/gtest.h>

#include "program.h"

namespace hwsim::cli::test {
namespace {

class Limits : public ::testing::Test {
 protected:
  void SetUp() override { place.write("triangle.gltf", kTriangleGltf); }
  /// A run that would take minutes, ended by the signal as soon as its folder is there.
  Outcome ended_by(const std::string& signal, const std::string& before = "") const {
    return place.shell(
        before +
        "hwsim run triangle.gltf -t ssaa16x,ssaa64x --resolution 2048x2048 --no-cache --out result & "
        "p=$!; until ls -d .result.partial-* >/dev/null 2>&1; do sleep 0.05; done; kill -" +
        signal + " $p; wait $p");
  }

  Workplace place;
};

TEST_F(Limits, SignalsEndWithTheirStatusAndLeaveNothing) {
  const std::vector<std::pair<std::string, int>> signals = {{"HUP", 129}, {"INT", 130}, {"TERM", 143}};
  for (const auto& [signal, status] : signals) {
    EXPECT_EQ(ended_by(signal).status, status) << signal;
    EXPECT_EQ(place.listing(), "triangle.gltf") << signal;
  }
}

TEST_F(Limits, WhatAKillLeavesIsRemovedByTheNextRun) {
  EXPECT_EQ(ended_by("KILL").status, 137);
  EXPECT_NE(place.listing().find(".result.partial-"), std::string::npos) << "a kill leaves no time to clean";
  EXPECT_EQ(place.hwsim("run triangle.gltf -t none --resolution 64x36 --no-image --out result").status, 0);
  EXPECT_EQ(place.listing(), "result triangle.gltf");
}

TEST_F(Limits, CachePruneRemovesWhatKilledRunsLeft) {
  EXPECT_EQ(ended_by("KILL", "mkdir runs; ln -s ../triangle.gltf runs; cd runs; ").status, 137);
  const Outcome outcome = place.hwsim("cache prune --older-than 9999");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find("of killed runs removed"), std::string::npos) << outcome.err;
  EXPECT_EQ(place.listing("runs"), "triangle.gltf");
}

TEST_F(Limits, FileBeyondTheLimitIsAnErrorAsAFullDiskIs) {
  const Outcome outcome = place.shell(
      "(ulimit -f 1; hwsim run triangle.gltf -t none --resolution 320x180 --no-cache --out result "
      "2>&1 >/dev/null; echo status $?) | cat >&2");
  EXPECT_NE(outcome.err.find("status 1"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("error["), std::string::npos) << outcome.err;
  EXPECT_EQ(place.listing(), "triangle.gltf");
}

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HWSIM_SANITIZED  // their shadow takes terabytes of addresses
#endif
#endif

TEST_F(Limits, MemoryThatIsNotThereEndsInAMessage) {
#ifdef HWSIM_SANITIZED
  GTEST_SKIP() << "a sanitizer runs under no limit of addresses";
#endif
  int refused = 0;
  for (int mib = 100; mib <= 800; mib += 100) {
    const Outcome outcome = place.shell(
        "ulimit -v " + std::to_string(mib * 1024) +
        "; hwsim run triangle.gltf -t ssaa16x --resolution 1920x1080 --no-cache --out result --force");
    if (outcome.err.find("loading shared libraries") != std::string::npos) continue;  // nothing of ours ran
    EXPECT_TRUE(outcome.status == 0 || outcome.status == 1 || outcome.status == 3)
        << mib << " MiB: " << outcome.status << outcome.err;
    if (outcome.status != 0) {
      ++refused;
      EXPECT_NE(outcome.err.find("error["), std::string::npos) << mib << " MiB: " << outcome.err;
      EXPECT_EQ(outcome.err.find("X001"), std::string::npos) << mib << " MiB: " << outcome.err;
    }
  }
  EXPECT_GT(refused, 0) << "no limit was small enough to be met";
}

}  // namespace
}  // namespace hwsim::cli::test
