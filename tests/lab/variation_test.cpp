// What words to try become: labels, overlays, settings.
#include "lab/studies/variation.h"

#include <gtest/gtest.h>

#include "hwsim/config/settings.h"

namespace hwsim::lab {
namespace {

std::vector<std::string> labels(const std::vector<Variation>& variations) {
  std::vector<std::string> found;
  for (const Variation& variation : variations) found.push_back(variation.label);
  return found;
}

TEST(Variations, OverlaysAndSettingsTogetherAreOneAndComeFirst) {
  const std::vector<Variation> variations =
      variations_of({.overlays = {"rops-x2"},
                     .sets = {parse_assignment("gpu.core_clock_mhz=x0.5")},
                     .what_ifs = {"a+b", "c"},
                     .points = {{parse_assignment("gpu.l2_size_kib=256"), parse_assignment("scene.seed=1")},
                                {parse_assignment("gpu.l2_size_kib=512")}}});
  EXPECT_EQ(labels(variations),
            (std::vector<std::string>{"rops-x2 gpu.core_clock_mhz=x0.5", "a+b", "c",
                                      "gpu.l2_size_kib=256 scene.seed=1", "gpu.l2_size_kib=512"}));
  EXPECT_EQ(variations[0].overlays, std::vector<std::string>{"rops-x2"});
  EXPECT_EQ(variations[0].sets.front().value, "x0.5");
  EXPECT_EQ(variations[1].overlays, (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(variations[1].sets.empty());
  EXPECT_EQ(variations[3].sets.size(), 2u);
}

TEST(TimeDirection, IsThatOfAllKeysThatChange) {
  GpuConfig gpu;
  gpu.dram_bandwidth_gb_s = 100.0;
  const auto direction = [&](const auto& change) {
    GpuConfig changed = gpu;
    change(changed);
    return time_direction(gpu, changed);
  };
  EXPECT_EQ(direction([](GpuConfig&) {}), 0);
  EXPECT_EQ(direction([](GpuConfig& g) { g.dram_bandwidth_gb_s *= 2; }), -1);
  EXPECT_EQ(direction([](GpuConfig& g) { g.dram_bandwidth_gb_s *= 0.5; }), 1);
  EXPECT_EQ(direction([](GpuConfig& g) { g.pass_overhead_us += 1; }), 1) << "a larger value is slower";
  EXPECT_EQ(direction([](GpuConfig& g) { g.dram_bandwidth_gb_s *= 2, g.pass_overhead_us += 1; }), 0);
  EXPECT_EQ(direction([](GpuConfig& g) { g.dram_bandwidth_gb_s *= 2, g.core_clock_mhz *= 2; }), 0)
      << "latencies are in cycles: the clock changes times both ways";
  EXPECT_EQ(direction([](GpuConfig& g) { g.features.native_msaa_max *= 2, g.dram_bandwidth_gb_s *= 2; }), 0)
      << "another frame is drawn";
}

TEST(Variations, NothingToTryIsNoVariation) { EXPECT_TRUE(variations_of({}).empty()); }

}  // namespace
}  // namespace hwsim::lab
