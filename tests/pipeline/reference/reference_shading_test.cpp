#include "pipeline/reference/reference_shading.h"

#include <gtest/gtest.h>

#include <numbers>

#include "pipeline/scene/mip_chain.h"
#include "pipeline/simd/scalar_lane-inl.h"
#include "pipeline/texture/texture_sampler-inl.h"

namespace hwsim::pipeline {
namespace {
using namespace HWY_NAMESPACE;  // the scalar lane of the static target

constexpr float kPi = std::numbers::pi_v<float>;

Mesh square(float half_m, float z_m) {
  Mesh mesh;
  mesh.positions = {
      {-half_m, -half_m, z_m}, {half_m, -half_m, z_m}, {half_m, half_m, z_m}, {-half_m, half_m, z_m}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  mesh.parts = {{0, 6, 0}};
  mesh.bounds_min = {-half_m, -half_m, z_m};
  mesh.bounds_max = {half_m, half_m, z_m};
  return mesh;
}

// A dielectric plane of roughness 1 (exponent 0, so the lobe is 1/pi everywhere) at 4 m, lit along (0, 0.6,
// 0.8).
Scene lit_plane() {
  Scene scene;
  scene.meshes = {square(100.0f, -4.0f)};
  scene.instances = {{0, glm::mat4(1.0f), "plane"}};
  Material material;
  material.base_color = {0.5f, 0.25f, 0.125f, 1.0f};
  material.metallic = 0.0f;
  scene.materials = {material};
  scene.samplers.resize(1);
  Light sun;
  sun.direction = {0.0f, -0.6f, -0.8f};
  sun.color = {0.5f, 0.75f, 1.0f};
  sun.casts_shadow = true;
  scene.lights = {sun};
  scene.cameras.resize(1);
  scene.ambient = {0.1f, 0.1f, 0.2f};
  return scene;
}

glm::vec3 lit(glm::vec3 albedo, float n_dot_l, glm::vec3 light) {
  return (albedo * n_dot_l + glm::vec3(0.04f / kPi)) * light;
}
const glm::vec3 kAlbedo(0.5f, 0.25f, 0.125f), kAmbient(0.1f, 0.1f, 0.2f), kSun(0.5f, 0.75f, 1.0f);

glm::vec3 middle_of(const Scene& scene, GroundTruthOptions options) {
  options.width = options.height = 1;
  if (options.offsets_px.empty()) options.offsets_px = {{0.0f, 0.0f}};
  return glm::vec3(render_ground_truth(scene, options).at(0, 0));
}

void expect_color(glm::vec3 seen, glm::vec3 expected, const char* what) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(seen[i], expected[i], 2e-6f) << what << ", channel " << i;
}

TEST(GroundTruth, OfALitPlaneIsItsClosedForm) {
  expect_color(middle_of(lit_plane(), {}), kAlbedo * kAmbient + lit(kAlbedo, 0.8f, kSun), "sun");
}

TEST(GroundTruth, OfAShadowedPlaneIsAmbientUnlessShadowsAreOff) {
  Scene scene = lit_plane();
  Mesh lid = square(0.5f, -3.0f);
  for (glm::vec3& p : lid.positions) p.y += 0.75f;  // where the ray to the sun passes, beside the camera's
  lid.bounds_min.y += 0.75f, lid.bounds_max.y += 0.75f;
  scene.meshes.push_back(lid);
  scene.instances.push_back({1, glm::mat4(1.0f), "lid"});
  expect_color(middle_of(scene, {}), kAlbedo * kAmbient, "shadowed");
  GroundTruthOptions options;
  options.shadows = false;
  expect_color(middle_of(scene, options), kAlbedo * kAmbient + lit(kAlbedo, 0.8f, kSun), "shadows off");
  scene.lights[0].casts_shadow = false;
  expect_color(middle_of(scene, {}), kAlbedo * kAmbient + lit(kAlbedo, 0.8f, kSun), "no caster");
}

TEST(GroundTruth, TakesTheLightsThatTheCallerAdds) {
  const Scene scene = lit_plane();
  LightingUniforms lighting = make_lighting(scene, scene.cameras[0]);
  PointLight light;
  light.position = {0.0f, 0.0f, -2.0f};
  light.inv_range2 = 1.0f / 16.0f;
  light.color = {1.0f, 0.5f, 0.25f};
  lighting.points = {light};
  lighting.point_count = 1;
  lighting.directional_count = 0;
  GroundTruthOptions options;
  options.lighting = lighting;
  const float window = 1.0f - 0.25f * 0.25f;  // (d / range)^2 = 1/4
  expect_color(middle_of(scene, options),
               kAlbedo * kAmbient + lit(kAlbedo, 1.0f, light.color * (window * window / 4.0f)),
               "point light");
}

TEST(GroundTruth, ClampsSamplesBeforeItAveragesThem) {
  Scene scene = lit_plane();
  scene.meshes[0] = square(4.0f, -4.0f);
  for (glm::vec3& p : scene.meshes[0].positions) p.x += 4.0f;  // the right half of the view
  scene.background = glm::vec3(0.0f);
  scene.lights[0].color = glm::vec3(100.0f);
  GroundTruthOptions options;
  options.offsets_px = {{-0.25f, 0.125f}, {0.25f, 0.125f}};
  expect_color(middle_of(scene, options), glm::vec3(0.5f), "half of 1");
}

TEST(GroundTruth, HasTheSameBitsOnAnyNumberOfThreads) {
  GroundTruthOptions options;
  options.width = 24;
  options.height = 16;
  options.samples = 5;
  const Image one = render_ground_truth(lit_plane(), options);
  options.jobs = 3;
  EXPECT_EQ(one.pixels, render_ground_truth(lit_plane(), options).pixels);
}

TEST(GroundTruth, CutsMaskMaterialsByTheirTexture) {
  Scene scene = lit_plane();
  Texture texture;
  texture.levels = mip_chain(1, 1, {0x40ffffffu}, true);
  scene.textures = {texture};
  scene.materials[0].base_color_texture.texture = 0;
  scene.materials[0].alpha_mode = AlphaMode::mask;
  scene.background = {0.25f, 0.5f, 0.75f};
  scene.materials[0].alpha_cutoff = 0.26f;  // 0x40 is 0.251
  expect_color(middle_of(scene, {}), scene.background, "below the cutoff");
  scene.materials[0].alpha_cutoff = 0.25f;
  expect_color(middle_of(scene, {}), kAlbedo * kAmbient + lit(kAlbedo, 0.8f, kSun), "above the cutoff");
}

using Sampled = TextureSampler<ScalarF, ScalarI, ScalarM>;

// 2x1 texels, 0 and 255, linear; so the coarse level is (0 + 255) / 2.
Scene two_texels(Wrap wrap) {
  Scene scene;
  Texture texture;
  texture.srgb = false;
  texture.levels = mip_chain(2, 1, {0xff000000u, 0xffffffffu}, false);
  scene.textures = {texture};
  scene.samplers.resize(1);
  scene.samplers[0].wrap_u = scene.samplers[0].wrap_v = wrap;
  return scene;
}

float red_at(const Scene& scene, float u, float lod) {
  const TextureStore store(scene);
  std::uint64_t probes = 0;
  return Sampled(*store.view({0, 0, 0}), nullptr, {true}).filter(u, 0.5f, lod, probes).x.v;
}

TEST(ScalarSampler, IsBilinearBetweenTexelCentersAndWrapsAsTold) {
  for (const Wrap wrap : {Wrap::repeat, Wrap::clamp_to_edge, Wrap::mirrored_repeat}) {
    EXPECT_FLOAT_EQ(red_at(two_texels(wrap), 0.25f, 0.0f), 0.0f);
    EXPECT_FLOAT_EQ(red_at(two_texels(wrap), 0.75f, 0.0f), 1.0f);
    EXPECT_FLOAT_EQ(red_at(two_texels(wrap), 0.375f, 0.0f), 0.25f);
  }
  EXPECT_FLOAT_EQ(red_at(two_texels(Wrap::repeat), 1.0f, 0.0f), 0.5f);
  EXPECT_FLOAT_EQ(red_at(two_texels(Wrap::clamp_to_edge), 1.0f, 0.0f), 1.0f);
  EXPECT_FLOAT_EQ(red_at(two_texels(Wrap::mirrored_repeat), 1.25f, 0.0f), 1.0f);
  EXPECT_FLOAT_EQ(red_at(two_texels(Wrap::repeat), 1.25f, 0.0f), 0.0f);
}

TEST(ScalarSampler, IsLinearBetweenLevels) {
  const Scene scene = two_texels(Wrap::repeat);
  const float coarse = red_at(scene, 0.75f, 1.0f);
  EXPECT_NEAR(coarse, 0.5f, 0.501f / 255.0f);  // to the nearest code
  EXPECT_FLOAT_EQ(red_at(scene, 0.75f, 0.25f), 1.0f + (coarse - 1.0f) * 0.25f);
  EXPECT_FLOAT_EQ(red_at(scene, 0.75f, 9.0f), coarse);
}

}  // namespace
}  // namespace hwsim::pipeline
