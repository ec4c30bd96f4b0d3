// The ray-traced ground truth and the emulated ssaa16x frame are two ways to the same sixteen samples a
// pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>

#include "algos/base/frame_parts.h"
#include "algos/techniques.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/image/metrics.h"
#include "pipeline/open/scene_source.h"
#include "pipeline/reference/reference_shading.h"
#include "pipeline/scene/mip_chain.h"
#include "pipeline/scene_glb.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

Texture noise_texture(int size, bool srgb, std::uint32_t seed) {
  std::vector<std::uint32_t> texels;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      seed = seed * 1664525u + 1013904223u;
      const std::uint32_t checker = ((x >> 3) ^ (y >> 3)) & 1 ? 0x00404040u : 0x00909090u;
      texels.push_back(0xff000000u | (checker + ((seed >> 9) & 0x001f1f1fu)));
    }
  Texture texture;
  texture.srgb = srgb;
  texture.levels = mip_chain(size, size, std::move(texels), srgb);
  return texture;
}

Mesh square() {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.tangents.assign(4, {1, 0, 0, 1});
  mesh.uv0 = {{-0.5f, 1.5f}, {1.5f, 1.5f}, {1.5f, -0.5f}, {-0.5f, -0.5f}};
  mesh.colors = {{1, 1, 1, 1}, {1, 0.5f, 1, 1}, {0.5f, 1, 1, 1}, {1, 1, 0.5f, 1}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  mesh.parts = {{0, 6, 0}};
  mesh.bounds_min = {-1, -1, 0};
  mesh.bounds_max = {1, 1, 0};
  return mesh;
}

// Squares that recede, one seen from behind and one mirrored, with all four kinds of textures.
Scene textured_squares(Wrap wrap, int max_anisotropy) {
  Scene scene;
  scene.meshes = {square()};
  glm::mat4 floor = glm::translate(glm::mat4(1.0f), {0.0f, -0.6f, -3.0f});
  floor = glm::rotate(floor, -1.35f, {1.0f, 0.0f, 0.0f});
  const glm::mat4 left = glm::translate(glm::mat4(1.0f), {-1.0f, 0.5f, -3.5f});
  const glm::mat4 right = glm::translate(glm::mat4(1.0f), {1.2f, 0.5f, -3.5f});
  scene.instances = {{0, glm::scale(floor, {2.0f, 2.0f, 1.0f}), "floor"},
                     {0, glm::rotate(left, 2.6f, {0.0f, 1.0f, 0.0f}), "from behind"},
                     {0, glm::scale(right, {-0.9f, 0.9f, 0.9f}), "mirrored"}};
  Material material;
  material.base_color = {0.9f, 0.8f, 0.7f, 1.0f};
  material.double_sided = true;
  material.base_color_texture.texture = 0;
  material.metallic_roughness_texture.texture = 1;
  material.normal_texture.texture = 1;
  material.emissive_texture.texture = 2;
  material.emissive = {0.1f, 0.05f, 0.2f};
  scene.materials = {material};
  scene.textures = {noise_texture(512, true, 1), noise_texture(256, false, 2), noise_texture(128, true, 3)};
  scene.samplers.resize(1);
  scene.samplers[0].wrap_u = scene.samplers[0].wrap_v = wrap;
  scene.samplers[0].max_anisotropy = max_anisotropy;
  Light sun;
  sun.direction = glm::normalize(glm::vec3(0.3f, -0.8f, -0.6f));
  scene.lights = {sun};
  scene.cameras.resize(1);
  return scene;
}

struct Pair {
  Image emulated, traced;
};

Pair both_ways(Scene scene, bool shadows, int point_lights) {
  FrameRequest request;
  request.scene = std::make_shared<const Scene>(std::move(scene));
  request.width_px = 160;
  request.height_px = 90;
  request.shadows = shadows;
  request.point_lights = point_lights;
  const FrameGraph graph = build_frame(parse_technique("ssaa16x"), request);
  GroundTruthOptions options;
  options.width = request.width_px;
  options.height = request.height_px;
  options.shadows = shadows;
  options.lighting = frame_lighting(request);
  for (int i = 0; i < 16; ++i)
    options.offsets_px.emplace_back(static_cast<float>(i % 4) / 4 - 0.375f,
                                    static_cast<float>(i / 4) / 4 - 0.375f);
  return {emulate(graph, request.features, request.functional, {}).color,
          render_ground_truth(*request.scene, options)};
}

double psnr_db(const Pair& pair, const char* what) {
  const double psnr = compare(pair.emulated, pair.traced).psnr_db;
  std::printf("%s: PSNR %.1f dB\n", what, psnr);
  return psnr;
}

// The rounding of the frame to 8 bits alone gives 58.9 dB.
TEST(GroundTruth, OfTexturedSquaresEqualsTheSupersampledFrame) {
  EXPECT_GE(psnr_db(both_ways(textured_squares(Wrap::repeat, 1), false, 0), "squares, trilinear"), 55.0);
  EXPECT_GE(
      psnr_db(both_ways(textured_squares(Wrap::mirrored_repeat, 8), false, 0), "squares, 8x anisotropic"),
      55.0);
  EXPECT_GE(psnr_db(both_ways(textured_squares(Wrap::clamp_to_edge, 1), false, 20), "squares, 20 lights"),
            55.0);
}

TEST(GroundTruth, OfAHallEqualsTheSupersampledFrame) {
  const pipeline::test::TemporaryFolder folder("ground_truth");
  const Scene hall = open_scene("sponza_hall", folder.path());
  EXPECT_GE(psnr_db(both_ways(hall, false, 0), "hall without shadows"), 55.0);
  // Shadows through a map have softer and moved edges.
  EXPECT_GE(psnr_db(both_ways(hall, true, 0), "hall with shadows"), 32.0);
}

}  // namespace
}  // namespace hwsim::algos
