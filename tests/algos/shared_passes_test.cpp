// Passes that techniques share, emulated once: neither image nor trace may know of it.
#include <gtest/gtest.h>

#include "algos/frame_run.h"
#include "pipeline/emulate/pass_memo.h"

namespace hwsim::test {
namespace {
using pipeline::Emulation;
using pipeline::EmulationOptions;
using pipeline::PassMemo;

constexpr std::uint64_t kPlenty = std::uint64_t{1} << 30;

std::vector<FrameSetup> setups(const std::string& scene) {
  std::vector<FrameSetup> all;
  for (const std::string& technique : technique_variants()) {
    const bool large = technique.starts_with("ssaa16x") || technique.starts_with("ssaa64x");
    if (!large) all.push_back({technique, scene, 128, 72});
  }
  return all;
}

std::vector<Emulation> run_all(const std::vector<FrameSetup>& setups, const EmulationOptions& options) {
  std::vector<Emulation> all;
  if (options.memo != nullptr)
    for (const FrameSetup& setup : setups)
      options.memo->expect(build_graph(setup), test_features(), FunctionalConfig{}, options);
  for (const FrameSetup& setup : setups) all.push_back(run_frame(setup, options));
  return all;
}

void expect_same(const std::vector<FrameSetup>& setups, const std::vector<Emulation>& a,
                 const std::vector<Emulation>& b) {
  for (std::size_t i = 0; i < setups.size(); ++i) {
    EXPECT_EQ(difference(a[i], b[i]), "") << setups[i].technique << " on " << setups[i].scene;
    EXPECT_EQ(a[i].skipped, b[i].skipped) << setups[i].technique << " on " << setups[i].scene;
  }
}

class SharedPassesOf : public ::testing::TestWithParam<std::string> {};

TEST_P(SharedPassesOf, AllTechniquesChangeNothing) {
  const std::vector<FrameSetup> all = setups(GetParam());
  const std::vector<Emulation> apart = run_all(all, {});
  for (const int jobs : {1, 3}) {
    PassMemo memo(kPlenty);
    EmulationOptions options;
    options.jobs = jobs;
    options.memo = &memo;
    expect_same(all, apart, run_all(all, options));
    EXPECT_GT(memo.reused_passes(), 2 * all.size()) << "the shadow map's clear and draw at least";
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SharedPassesOf,
                         ::testing::Values("sponza_hall:bays=4", "grass:blades=2000", "wires"),
                         [](const auto& tested) { return tested.param.substr(0, tested.param.find(':')); });

TEST(SharedPasses, WhatThereIsNoRoomForIsEmulatedAgain) {
  const std::vector<FrameSetup> all = setups("sponza_hall:bays=4");
  const std::vector<Emulation> apart = run_all(all, {});
  for (const std::uint64_t limit : {std::uint64_t{0}, std::uint64_t{1} << 21}) {
    PassMemo memo(limit);
    EmulationOptions options;
    options.memo = &memo;
    expect_same(all, apart, run_all(all, options));
  }
}

TEST(SharedPasses, FiltersGoOnWithTheFrameBelow) {
  PassMemo memo(kPlenty);
  EmulationOptions options;
  options.memo = &memo;
  const std::vector<FrameSetup> all = {{"none", "sponza_hall:bays=4"}, {"none+fxaa", "sponza_hall:bays=4"}};
  const std::vector<Emulation> frames = run_all(all, options);
  EXPECT_EQ(frames[0].reused_passes, 0u);
  EXPECT_EQ(frames[1].reused_passes, frames[0].trace.passes.size()) << "all but the filter's own";
}

TEST(SharedPasses, FramesThatWereNotExpectedShareNothing) {
  PassMemo memo(kPlenty);
  EmulationOptions options;
  options.memo = &memo;
  const FrameSetup setup{"none", "sponza_hall:bays=4", 64, 36};
  for (int i = 0; i < 2; ++i) EXPECT_EQ(run_frame(setup, options).reused_passes, 0u);
}

TEST(SharedPasses, AnotherViewIsAnotherFrame) {
  PassMemo memo(kPlenty);
  EmulationOptions options;
  options.memo = &memo;
  std::vector<FrameSetup> all = {{"none", "sponza_hall:bays=4", 64, 36},
                                 {"none", "sponza_hall:bays=4", 64, 40}};
  const std::vector<Emulation> frames = run_all(all, options);
  EXPECT_EQ(difference(frames[1], run_frame(all[1], {})), "");
  EXPECT_LT(frames[1].reused_passes, frames[1].trace.passes.size());
}

}  // namespace
}  // namespace hwsim::test
