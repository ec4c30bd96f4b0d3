// Shadows of aggregates: the taps stay on what receives them (docs/techniques/agaa.md#shading).
#include <gtest/gtest.h>

#include "algos/agaa_frames.h"

namespace hwsim::test {
namespace {

/// Two slopes that meet in a ridge across a column of pixels, lit from the side, with nothing above them.
std::shared_ptr<const pipeline::Scene> lit_roof() {
  pipeline::Scene scene =
      patches({{-4, 0.02f, -3.618f, {0.8f, 0.8f, 0.8f}, 0.9f}, {0.02f, 4, 0, {0.8f, 0.8f, 0.8f}, -0.9f}});
  scene.lights[0].casts_shadow = true;
  scene.lights[0].direction = glm::normalize(glm::vec3(0.1f, -0.6f, -1.0f));
  return share(std::move(scene));
}

/// The most that shadows change of a picture without anything that casts them.
float self_shadow(const std::string& technique, int shadow_map_px) {
  const auto scene = lit_roof();
  const pipeline::Image with =
                            render({scene, technique, test_features(), kWidth, kHeight, shadow_map_px}).color,
                        without = render({scene, technique}).color;
  return largest_difference(with, without);
}

TEST(AgaaShadows, StayOffTheirReceiverHoweverFineTheMap) {
  for (const int size : {256, 1024, 4096})
    for (const char* technique :
         {"agaa", "agaa:shadow_taps=8", "agaa:accumulate=atomics", "agaa:shadow_axis=places"})
      EXPECT_LT(self_shadow(technique, size), 2.0f / 255.0f) << technique << ", " << size;
}

// Why the default goes another way: along the ray, the finer the map, the darker the slope.
TEST(AgaaShadows, AlongTheRayHalfTheTapsLieBelowASlope) {
  EXPECT_GT(self_shadow("agaa:shadow_axis=depth", 4096), 0.1f);
}

// One aggregate of two walls a meter apart, the further one in the shadow of the nearer: the axis goes from
// one to the other, so some taps see the light and some do not.
TEST(AgaaShadows, AreFilteredOverTheDepthOfAnAggregate) {
  pipeline::Scene scene = patches({{-4, 0.036f, 0, {0.8f, 0.8f, 0.8f}}, {0.036f, 4, -1, {0.8f, 0.8f, 0.8f}}});
  scene.lights[0].casts_shadow = true;
  scene.lights[0].direction = glm::normalize(glm::vec3(0.8f, 0.0f, -1.0f));
  const auto shared = share(std::move(scene));
  const auto column = [&](const char* technique) {
    const pipeline::Image image = render({shared, technique, test_features(), kWidth, kHeight, 2048}).color;
    return image.at(kWidth / 2, kHeight / 2).x;
  };
  const float lit = render({shared, "agaa:c=1"}).color.at(kWidth / 2, kHeight / 2).x;
  EXPECT_LT(column("agaa:c=1"), 0.7f * lit);
  EXPECT_GT(column("agaa:c=1"), 0.2f * lit);
}

}  // namespace
}  // namespace hwsim::test
