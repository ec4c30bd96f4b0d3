// What an alpha test discards leaves nothing behind: not in the image, and not in the bounds by which tiles
// are rejected.
#include <gtest/gtest.h>

#include "algos/frame_run.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

Mesh square(float half, int material) {
  Mesh mesh;
  mesh.positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.indices = {0, 1, 2, 0, 2, 3};
  mesh.parts = {{0, 6, material}};
  mesh.bounds_min = {-half, -half, 0};
  mesh.bounds_max = {half, half, 0};
  return mesh;
}

glm::mat4 moved(float x, float y, float z) {
  glm::mat4 m(1.0f);
  m[3] = {x, y, z, 1.0f};
  return m;
}

// A square, both materials alpha-tested, behind specks that are discarded whole: each speck lies in a tile
// of its own that nothing has drawn to before.
Scene square_behind_specks(int specks) {
  Scene scene;
  scene.meshes = {square(0.002f, 0), square(2.0f, 1)};
  for (int i = 0; i < specks; ++i)
    scene.instances.push_back(
        {0, moved(0.1f * static_cast<float>(i % 5) - 0.2f, 0.1f * static_cast<float>(i / 5) - 0.2f, -1.0f),
         "speck"});
  scene.instances.push_back({1, moved(0, 0, -3), "square"});
  scene.materials.resize(2);
  for (Material& m : scene.materials) m.alpha_mode = AlphaMode::mask, m.base_color = {0.8f, 0.5f, 0.3f, 1.0f};
  scene.materials[0].base_color.w = 0.0f;
  scene.samplers.resize(1);
  Light sun;
  sun.direction = {0.0f, 0.0f, -1.0f};
  scene.lights = {sun};
  scene.cameras.resize(1);
  return scene;
}

Emulation run(const std::string& technique, int specks) {
  FrameRequest request;
  request.scene = std::make_shared<const Scene>(square_behind_specks(specks));
  request.width_px = 128;
  request.height_px = 72;
  request.shadows = false;
  return emulate(build_frame(parse_technique(technique), request), request.features, request.functional, {});
}

TEST(Discard, DiscardedFragmentsDoNotHideWhatIsBehind) {
  for (const char* technique : {"none", "msaa4x", "deferred", "ssaa4x:variant=sample_rate"})
    EXPECT_EQ(test::difference(run(technique, 25).color, run(technique, 0).color, technique), "");
}

}  // namespace
}  // namespace hwsim::algos
