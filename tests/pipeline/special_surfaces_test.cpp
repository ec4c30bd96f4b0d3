// Which materials ask for more than a G-buffer may hold.
#include "pipeline/scene/special_surfaces.h"

#include <gtest/gtest.h>

#include "pipeline/gltf/gltf_loader.h"
#include "tests/pipeline/image/make_png.h"
#include "tests/pipeline/scene_glb.h"

namespace hwsim::pipeline {
namespace {
using nlohmann::json;
using test::GlbBuilder;
using test::TemporaryFolder;

std::vector<SpecialSurface> found(const json& material,
                                  std::array<std::uint8_t, 4> texel = {255, 255, 255, 255}) {
  GlbBuilder glb;
  glb.add_attribute("POSITION", {-1, -1, 0, 1, -1, 0, -1, 1, 0}, "VEC3", 3);
  glb.add_attribute("TEXCOORD_0", {0, 0, 1, 0, 0, 1}, "VEC2", 2);
  glb.primitive()["material"] = 0;
  const int view = glb.add_view(testing::make_png({1, 1}, {texel[0], texel[1], texel[2], texel[3]}));
  glb.root["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
  glb.root["textures"] = {{{"source", 0}}};
  glb.root["materials"] = {material, {{"name", "drawn by nothing"}, {"emissiveFactor", {1, 0, 0}}}};
  glb.root["extensionsUsed"] = {"KHR_materials_unlit"};
  const TemporaryFolder folder("special");
  return special_surfaces(load_gltf(folder.write("scene.glb", glb.bytes())));
}

const json kTexture = {{"index", 0}};

TEST(SpecialSurfaces, PlainMaterialsAreNone) {
  EXPECT_TRUE(found({{"name", "plain"}}).empty());
  EXPECT_TRUE(found({{"emissiveFactor", {0, 0, 0}}, {"emissiveTexture", kTexture}}).empty());
  EXPECT_TRUE(found({{"occlusionTexture", {{"index", 0}, {"strength", 0}}}}).empty());
}

TEST(SpecialSurfaces, ColorOfEmissionIsFactorTimesTexture) {
  const auto colored = [&](const json& material, std::array<std::uint8_t, 4> texel) {
    const auto surfaces = found(material, texel);
    EXPECT_EQ(surfaces.size(), 1u);
    return surfaces.at(0).colored_emission;
  };
  const json white = {{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", kTexture}},
             red = {{"emissiveFactor", {1, 0, 0}}}, faint = {{"emissiveFactor", {0.5, 0.499, 0.5}}};
  EXPECT_FALSE(colored(white, {200, 200, 200, 255}));
  EXPECT_TRUE(colored(white, {200, 180, 200, 255}));
  EXPECT_TRUE(colored(red, {255, 255, 255, 255}));
  EXPECT_FALSE(colored(faint, {255, 255, 255, 255}));
}

TEST(SpecialSurfaces, AreNamedWithAllThatTheyAre) {
  EXPECT_EQ(found({{"name", "wall"}, {"occlusionTexture", kTexture}}),
            (std::vector<SpecialSurface>{{.material = "wall", .occluded = true}}));
  EXPECT_EQ(found({{"alphaMode", "BLEND"}, {"emissiveFactor", {0, 1, 0}}}),
            (std::vector<SpecialSurface>{
                {.material = "materials[0]", .blended = true, .emissive = true, .colored_emission = true}}));
  // Unlit surfaces show base color: nothing else of the material counts.
  EXPECT_EQ(found({{"name", "sky"},
                   {"emissiveFactor", {0, 1, 0}},
                   {"extensions", {{"KHR_materials_unlit", json::object()}}}}),
            (std::vector<SpecialSurface>{{.material = "sky", .unlit = true}}));
}

}  // namespace
}  // namespace hwsim::pipeline
