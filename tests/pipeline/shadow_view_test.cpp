// The view along a light that casts shadows: a share of the scene's size around it, whatever its unit.
#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/scene/shadow_view.h"

namespace hwsim::pipeline {
namespace {

Scene box_of(const glm::vec3& low, const glm::vec3& high) {
  Scene scene;
  scene.materials.emplace_back();
  Mesh mesh;
  mesh.bounds_min = low;
  mesh.bounds_max = high;
  mesh.parts.emplace_back();
  scene.meshes.push_back(mesh);
  scene.instances.push_back({0, glm::mat4(1.0f), "box"});
  return scene;
}

const glm::vec3 kToLight = glm::normalize(glm::vec3(0.3f, 0.8f, -0.5f));

TEST(ShadowView, ScalesWithTheSceneBitByBit) {
  const glm::vec3 low(-3, 0, 1), high(5, 2.5f, 2);
  const glm::mat4 view = shadow_clip_from_world(box_of(low, high), kToLight);
  for (const float scale : {0x1p-10f, 0x1p13f}) {
    const glm::mat4 scaled = shadow_clip_from_world(box_of(low * scale, high * scale), kToLight);
    for (int column = 0; column < 4; ++column)
      EXPECT_EQ(column < 3 ? scaled[column] * scale : scaled[column], view[column]) << scale << " " << column;
  }
}

TEST(ShadowView, HoldsTheSceneWithAMargin) {
  for (const glm::vec3& high : {glm::vec3(5, 2.5f, 2), glm::vec3(5, 0, 2), glm::vec3(5, 0, 0)}) {
    const Scene scene = box_of(glm::vec3(0.0f), high);
    for (const glm::vec3& to_light : {kToLight, glm::vec3(0, 1, 0), glm::vec3(1, 0, 0)}) {
      const glm::mat4 view = shadow_clip_from_world(scene, to_light);
      for (int i = 0; i < 8; ++i) {
        const glm::vec4 p =
            view * glm::vec4(i & 1 ? high.x : 0.0f, i & 2 ? high.y : 0.0f, i & 4 ? high.z : 0.0f, 1);
        EXPECT_LT(std::max(std::abs(p.x), std::abs(p.y)), 0.99f);
        EXPECT_GT(p.z, -0.995f);
        EXPECT_LT(p.z, 0.995f);
      }
    }
  }
}

TEST(ShadowView, IsANumberForASceneOfOnePoint) {
  const glm::mat4 view = shadow_clip_from_world(box_of(glm::vec3(1.0f), glm::vec3(1.0f)), kToLight);
  for (int i = 0; i < 16; ++i) EXPECT_TRUE(std::isfinite(view[i / 4][i % 4]));
}

}  // namespace
}  // namespace hwsim::pipeline
