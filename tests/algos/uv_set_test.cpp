// Textures on the second set of coordinates, and occlusion textures.
#include <gtest/gtest.h>

#include <functional>

#include "algos/frame_run.h"
#include "pipeline/scene/mip_chain.h"

namespace hwsim {
namespace {
using namespace pipeline;

Texture texture_of(bool srgb, const std::function<std::uint32_t(int, int)>& texel) {
  constexpr int kSize = 32;
  std::vector<std::uint32_t> texels;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) texels.push_back(texel(x, y));
  Texture texture;
  texture.srgb = srgb;
  texture.levels = mip_chain(kSize, kSize, std::move(texels), srgb);
  return texture;
}

// A leaf-like alpha-tested square above a floor, on which it throws a shadow.
Scene masked_square(int set) {
  Mesh mesh;
  for (const float y : {0.0f, -1.0f}) {
    const float half = y < 0.0f ? 3.0f : 0.8f;
    for (const glm::vec2 c : {glm::vec2(-1, 1), glm::vec2(1, 1), glm::vec2(1, -1), glm::vec2(-1, -1)}) {
      mesh.positions.emplace_back(half * c.x, y, half * c.y - 3.0f);
      mesh.normals.emplace_back(0, 1, 0);
      (set == 1 ? mesh.uv1 : mesh.uv0).push_back(c * 0.9f);
      (set == 1 ? mesh.uv0 : mesh.uv1).emplace_back(0.1f * c.y, 0.3f);
    }
  }
  mesh.indices = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
  mesh.parts = {{0, 6, 0}, {6, 6, 1}};
  mesh.bounds_min = {-3, -1, -6};
  mesh.bounds_max = {3, 0, 0};
  Scene scene;
  scene.meshes = {mesh};
  scene.instances = {{0, glm::mat4(1.0f), "both"}};
  scene.materials.resize(2);
  scene.materials[0].alpha_mode = AlphaMode::mask;
  scene.materials[0].double_sided = true;
  for (Material& m : scene.materials) {
    m.metallic = 0.0f;
    m.base_color_texture = {0, 0, set};
    m.metallic_roughness_texture = {1, 0, set};
    m.emissive_texture = {0, 0, set};
    m.occlusion_texture = {1, 0, set};
    m.emissive = {0.1f, 0.2f, 0.0f};
  }
  scene.textures = {texture_of(true,
                               [](int x, int y) {
                                 const bool hole = (x / 6 + y / 4) % 2 == 0;
                                 return (hole ? 0u : 0xff000000u) |
                                        static_cast<std::uint32_t>(x * 7 + y * 0x500 + 0x300000);
                               }),
                    texture_of(false, [](int x, int y) {
                      return 0xff808000u + static_cast<std::uint32_t>(x * 4 + y * 3);
                    })};
  scene.samplers.resize(1);
  Light sun;
  sun.direction = glm::normalize(glm::vec3(0.2f, -1.0f, -0.1f));
  sun.casts_shadow = true;
  scene.lights = {sun};
  scene.cameras.resize(1);
  scene.cameras[0].view_from_world[3] = {0.0f, -0.6f, -1.0f, 1.0f};
  return scene;
}

Image render(Scene scene, const std::string& technique) {
  algos::FrameRequest request;
  request.scene = std::make_shared<const Scene>(std::move(scene));
  request.width_px = 128;
  request.height_px = 72;
  request.shadow_map_px = 256;
  return emulate(algos::build_frame(algos::parse_technique(technique), request), request.features,
                 request.functional, {})
      .color;
}

TEST(UvSet, TexturesAreReadAtTheSetThatTheMaterialNames) {
  for (const char* technique : {"none", "msaa4x", "deferred"}) {
    const Image first = render(masked_square(0), technique), second = render(masked_square(1), technique);
    EXPECT_EQ(test::difference(first, second, technique), "");
  }
  Scene wrong = masked_square(1);
  wrong.materials[0].base_color_texture.uv_set = 0;
  EXPECT_NE(test::difference(render(wrong, "none"), render(masked_square(1), "none"), "wrong set"), "");
}

// No light from the sun's side: what is left is albedo * ambient * (1 - strength (1 - texel)).
TEST(UvSet, OcclusionDarkensAmbientLight) {
  Scene scene = masked_square(0);
  scene.materials[1] = Material();
  scene.materials[1].base_color = {0.8f, 0.8f, 0.8f, 1.0f};
  scene.materials[1].metallic = 0.0f;
  scene.materials[1].occlusion_texture = {2, 0, 0};
  scene.materials[1].occlusion_strength = 0.75f;
  scene.textures.push_back(texture_of(false, [](int, int) { return 0xff000033u; }));  // 0.2
  scene.lights[0].direction = {0.0f, 1.0f, 0.0f};
  scene.ambient = glm::vec3(0.5f);
  const Image image = render(scene, "none");
  const float want = 0.8f * 0.5f * (1.0f - 0.75f * 0.8f);
  EXPECT_NEAR(image.at(64, 70).x, want, 0.003f);
  scene.materials[1].occlusion_strength = 0.0f;
  EXPECT_NEAR(render(scene, "none").at(64, 70).x, 0.4f, 0.003f);
}

}  // namespace
}  // namespace hwsim
