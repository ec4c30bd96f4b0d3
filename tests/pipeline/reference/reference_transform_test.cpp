// Transformations at the edge of what floats and Embree hold: what the rasterizer draws, rays must meet.
#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/emulate/material_views.h"
#include "pipeline/reference/reference.h"

namespace hwsim::pipeline {
namespace {

glm::mat4 placed(const glm::vec3& scale, float z) {
  glm::mat4 m(1.0f);
  for (int i = 0; i < 3; ++i) m[i][i] = scale[i];
  m[3] = {0, 0, z, 1};
  return m;
}

// A square from -size to size in the plane z = 0, front to +z, seen from the origin along -z.
Scene square_scene(float size, const glm::mat4& world_from_local) {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{-size, -size, 0}, {size, -size, 0}, {size, size, 0}, {-size, size, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.indices = {0, 1, 2, 0, 2, 3};
  mesh.parts = {{0, 6, 0}};
  scene.meshes.push_back(mesh);
  scene.materials.resize(1);
  scene.cameras.resize(1);
  scene.instances = {{0, world_from_local, "square"}};
  return scene;
}

Visibility seen_in_the_middle(const Scene& scene) {
  ReferenceOptions options;
  options.width = options.height = 1;
  options.offsets_px = {{0.01f, 0.03f}};
  return trace_visibility(ReferenceScene(scene), options).front();
}

TEST(ReferenceTransform, AFlattenedInstanceIsSeenAndFacesTheViewer) {
  const Scene scene = square_scene(1.0f, placed({1, 1, 0}, -4));
  const Visibility hit = seen_in_the_middle(scene);
  ASSERT_TRUE(hit);
  EXPECT_TRUE(hit.front_face);
  EXPECT_NEAR(hit.t, 4.0f, 1e-5f);
  PixelRay pixel;
  pixel.ray.direction = {0, 0, -1};
  const SurfaceHit surface = ReferenceScene(scene).surface(hit, pixel);
  EXPECT_NEAR(surface.normal.z, 1.0f, 1e-6f);
  EXPECT_NEAR(surface.position.z, -4.0f, 1e-5f);
}

TEST(ReferenceTransform, ScalesBeyondEmbreeAreMetAndNothingAborts) {
  for (const float scale : {1e-18f, 1e-10f, 1e-7f, 1.0f, 1e7f, 1e10f}) {
    const Visibility hit = seen_in_the_middle(square_scene(1.0f / scale, placed(glm::vec3(scale), -4)));
    ASSERT_TRUE(hit) << scale;
    EXPECT_TRUE(hit.front_face) << scale;
    EXPECT_NEAR(hit.t, 4.0f, 1e-5f) << scale;
    EXPECT_EQ(hit.instance, 0u);
  }
}

TEST(ReferenceTransform, AMirroredTinyInstanceKeepsItsFrontFace) {
  const float scale = 1e-10f;
  const glm::mat4 mirrored = placed({-scale, scale, scale}, -4);
  EXPECT_TRUE(is_mirrored(mirrored));
  const Visibility hit = seen_in_the_middle(square_scene(1.0f / scale, mirrored));
  ASSERT_TRUE(hit);
  EXPECT_TRUE(hit.front_face);
  Scene behind = square_scene(1.0f / scale, placed({-scale, scale, -scale}, -4));  // turned around: its back
  EXPECT_FALSE(seen_in_the_middle(behind));
  behind.materials[0].double_sided = true;
  EXPECT_FALSE(seen_in_the_middle(behind).front_face);
}

TEST(NormalMatrix, KeepsDirectionsAtAnyScale) {
  glm::mat4 turned(1.0f);
  turned[0] = {0.6f, 0.8f, 0, 0};
  turned[1] = {-0.8f, 0.6f, 0, 0};
  for (const float scale : {1e-30f, 1e-18f, 3e-8f, 1.0f, 4e9f, 1e18f}) {
    glm::mat4 m = turned;
    for (int i = 0; i < 3; ++i) m[i] *= scale;
    const glm::vec3 n = normal_from_local(m) * glm::vec3(1, 0, 0);
    const float length = glm::length(n);
    ASSERT_TRUE(std::isnormal(length) && std::isnormal(length * length)) << scale;
    EXPECT_NEAR(n.x / length, 0.6f, 1e-6f) << scale;
    EXPECT_NEAR(n.y / length, 0.8f, 1e-6f) << scale;
  }
}

}  // namespace
}  // namespace hwsim::pipeline
