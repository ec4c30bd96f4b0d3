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

TEST(Variations, NothingToTryIsNoVariation) { EXPECT_TRUE(variations_of({}).empty()); }

}  // namespace
}  // namespace hwsim::lab
