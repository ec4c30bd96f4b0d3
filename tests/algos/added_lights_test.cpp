// Lights that a request adds: their box, their reach, their seed, and frames that have no others.
#include <gtest/gtest.h>

#include "algos/base/frame_parts.h"
#include "algos/frame_run.h"
#include "pipeline/scene/scene.h"

namespace hwsim::algos {
namespace {

FrameRequest boxed(int seed = 0) {
  FrameRequest request;
  request.scene = hwsim::test::generated_scene("sponza_hall:bays=4");
  request.point_lights = 400;
  request.lights = LightProfile::added;
  request.added = {{4.0, 2.0, 6.0}, 1.5, 6.5, seed};
  return request;
}

TEST(AddedLights, LieInTheirBoxAndReachBetweenTheirBounds) {
  const FrameRequest request = boxed();
  const pipeline::LightingUniforms lighting = frame_lighting(request);
  ASSERT_EQ(lighting.point_count, 400);
  const pipeline::SceneStats s = pipeline::stats(*request.scene);
  const glm::vec3 middle = 0.5f * (s.bounds_min + s.bounds_max);
  float least = 1e9f, most = 0.0f, sum = 0.0f;
  for (const pipeline::PointLight& light : lighting.points) {
    const glm::vec3 d = glm::abs(light.position - middle);
    EXPECT_TRUE(d.x <= 2.001f && d.y <= 1.001f && d.z <= 3.001f);
    const float range = 1.0f / std::sqrt(light.inv_range2);
    least = std::min(least, range);
    most = std::max(most, range);
    sum += range / 400.0f;
  }
  EXPECT_NEAR(least, 1.5f, 0.1f);
  EXPECT_NEAR(most, 6.5f, 0.1f);
  EXPECT_NEAR(sum, 4.0f, 0.25f) << "even between both";
}

TEST(AddedLights, AreTheOnlyOnesWhereTheFrameAsksForThemAlone) {
  FrameRequest request = boxed();
  EXPECT_EQ(frame_lighting(request).directional_count, 0);
  request.lights = LightProfile::scene;
  EXPECT_GT(frame_lighting(request).directional_count, 0);
}

TEST(AddedLights, OfAnotherSeedAreOthers) {
  const auto first = [](int seed) { return frame_lighting(boxed(seed)).points.front().position; };
  EXPECT_EQ(first(0), first(0));
  EXPECT_NE(first(0), first(1));
}

}  // namespace
}  // namespace hwsim::algos
