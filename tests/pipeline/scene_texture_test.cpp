#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/generate/png.h"
#include "pipeline/gltf/gltf_loader.h"
#include "pipeline/gltf/vertices.h"
#include "pipeline/image/image.h"
#include "pipeline/scene/mip_chain.h"
#include "tests/pipeline/scene_glb.h"

namespace hwsim::pipeline {
namespace {

int channel(std::uint32_t texel, int i) { return static_cast<int>((texel >> (8 * i)) & 255); }

TEST(MipChain, AveragesLightNotCodes) {
  const std::uint32_t black = 0xff000000u, white = 0x00ffffffu;
  const auto srgb = mip_chain(2, 2, {black, white, white, black}, true);
  ASSERT_EQ(srgb.size(), 2u);
  EXPECT_EQ(channel(srgb[1].texels[0], 0), 188);  // half the light: srgb(0.5) = 0.7354
  EXPECT_EQ(channel(srgb[1].texels[0], 3), 128);  // alpha is linear
  const auto data = mip_chain(2, 2, {black, white, white, black}, false);
  EXPECT_EQ(channel(data[1].texels[0], 0), 128);
}

TEST(MipChain, EveryUniformColorStaysExact) {
  for (std::uint32_t code = 0; code < 256; ++code) {
    const std::uint32_t texel = code * 0x01010101u;
    for (const auto& level : mip_chain(5, 4, std::vector<std::uint32_t>(20, texel), true))
      for (const std::uint32_t t : level.texels) ASSERT_EQ(t, texel);
  }
}

TEST(MipChain, OddSidesWeighByArea) {
  const auto levels = mip_chain(3, 1, {30, 60, 90}, false);  // one texel of three: the mean of all
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_EQ(levels[1].width, 1);
  EXPECT_EQ(channel(levels[1].texels[0], 0), 60);
  const auto five = mip_chain(5, 1, {0, 0, 100, 0, 200}, false);  // 2.5 texels each
  EXPECT_EQ(five[1].width, 2);
  EXPECT_EQ(channel(five[1].texels[0], 0), 20);   // (0 + 0 + 100 / 2) / 2.5
  EXPECT_EQ(channel(five[1].texels[1], 0), 100);  // (100 / 2 + 0 + 200) / 2.5
}

TEST(MipChain, TwoTexelsMatchTheTransferFunction) {
  for (int a = 0; a < 256; a += 5)
    for (int b = 0; b < 256; b += 3) {
      const auto levels =
          mip_chain(2, 1, {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)}, true);
      const float light = 0.5f * (linear_from_srgb(static_cast<float>(a) / 255.0f) +
                                  linear_from_srgb(static_cast<float>(b) / 255.0f));
      EXPECT_NEAR(channel(levels[1].texels[0], 0), 255.0f * srgb_from_linear(light), 0.6f) << a << ' ' << b;
    }
}

// A textured square: base color as sRGB and the same image as normal data, which needs tangents.
test::GlbBuilder textured_square() {
  auto glb = test::square_glb();
  glb.add_attribute("TEXCOORD_0", {0, 1, 1, 1, 0, 0, 1, 0}, "VEC2", 2);
  const int view = glb.add_view(generate::encode_png(2, 2, {0x0000ff, 0x00ff00, 0xff0000, 0x808080}));
  glb.root["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
  glb.root["samplers"] = {{{"magFilter", 9728}, {"minFilter", 9985}, {"wrapS", 33071}, {"wrapT", 33648}}};
  glb.root["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 0}}};
  glb.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                            {"normalTexture", {{"index", 1}, {"scale", 0.5}}}}};
  glb.primitive()["material"] = 0;
  return glb;
}

TEST(SceneTexture, ImagesComeWithSamplersColorSpaceAndTangents) {
  const test::TemporaryFolder folder("textured");
  const Scene scene = load_gltf(folder.write("scene.glb", textured_square().bytes()));
  ASSERT_EQ(scene.textures.size(), 2u);
  const Material& m = scene.materials[0];
  const Texture& color = scene.textures[static_cast<std::size_t>(m.base_color_texture.texture)];
  EXPECT_TRUE(color.srgb);
  EXPECT_FALSE(scene.textures[static_cast<std::size_t>(m.normal_texture.texture)].srgb);
  EXPECT_EQ(color.levels[0].texels,
            (std::vector<std::uint32_t>{0xff0000ff, 0xff00ff00, 0xffff0000, 0xff808080}));
  const Sampler& sampler = scene.samplers[static_cast<std::size_t>(m.base_color_texture.sampler)];
  EXPECT_EQ(sampler.mag, Filter::nearest);
  EXPECT_EQ(sampler.min, Filter::linear);
  EXPECT_EQ(sampler.mip, MipFilter::nearest);
  EXPECT_EQ(sampler.wrap_u, Wrap::clamp_to_edge);
  EXPECT_EQ(sampler.wrap_v, Wrap::mirrored_repeat);
  EXPECT_EQ(m.normal_texture.sampler, 0);
  // u grows along +x and v down: glTF's bitangent cross(n, t) w points along growing v's opposite, +y in
  // glTF's images.
  for (const glm::vec4& t : scene.meshes[0].tangents) {
    EXPECT_NEAR(t.x, 1.0f, 1e-6f);
    EXPECT_EQ(t.w, -1.0f);
  }
}

TEST(SceneTexture, GeneratedTangentsCopyOnlyTheVerticesInUse) {
  const test::TemporaryFolder folder("own_copies");
  auto glb = textured_square();
  auto second = glb.primitive();
  second["indices"] = glb.add_accessor<std::uint16_t>({2, 1, 3}, 5123, "SCALAR", 1);
  glb.root["meshes"][0]["primitives"].push_back(second);
  const Scene scene = load_gltf(folder.write("scene.glb", glb.bytes()));
  const Mesh& mesh = scene.meshes[0];
  EXPECT_EQ(mesh.positions.size(), 4u + 3u);
  EXPECT_EQ(mesh.tangents.size(), mesh.positions.size());
  const std::uint32_t* last = &mesh.indices[6];
  EXPECT_EQ(mesh.positions[last[0]], glm::vec3(0, 1, 0));
  EXPECT_EQ(mesh.positions[last[1]], glm::vec3(1, 0, 0));
  EXPECT_EQ(mesh.positions[last[2]], glm::vec3(1, 1, 0));
}

TEST(SceneTexture, AnImageThatIsNoneIsAnError) {
  const test::TemporaryFolder folder("broken_image");
  auto glb = textured_square();
  glb.root["images"][0] = {{"uri", "missing.png"}};
  EXPECT_THROW(load_gltf(folder.write("scene.glb", glb.bytes())), InputError);
  folder.write("missing.png", {'n', 'o', 't', ' ', 'a', ' ', 'p', 'n', 'g'});
  EXPECT_THROW(load_gltf(folder.path() + "/scene.glb"), InputError);
  auto unused = textured_square();
  unused.root["images"][0] = {{"uri", "missing.png"}};
  unused.primitive().erase("material");
  EXPECT_NO_THROW(load_gltf(folder.write("scene.glb", unused.bytes())));
}

TEST(SceneTangents, MirroredCoordinatesFlipTheHandedness) {
  gltf::Vertices v;
  v.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  v.normals.assign(3, {0, 0, 1});
  v.uv0 = {{0, 0}, {1, 0}, {0, 1}};
  gltf::generate_tangents(v, {0, 1, 2}, 0);
  for (const glm::vec4& t : v.tangents) EXPECT_EQ(t, glm::vec4(1, 0, 0, 1));
  v.uv0 = {{0, 0}, {-1, 0}, {0, 1}};
  gltf::generate_tangents(v, {0, 1, 2}, 0);
  for (const glm::vec4& t : v.tangents) EXPECT_EQ(t, glm::vec4(-1, 0, 0, -1));
  v.uv0.assign(3, {0.5f, 0.5f});  // no direction at all: still unit and perpendicular
  gltf::generate_tangents(v, {0, 1, 2}, 0);
  for (const glm::vec4& t : v.tangents) {
    EXPECT_NEAR(glm::length(glm::vec3(t)), 1.0f, 1e-6f);
    EXPECT_EQ(t.z, 0.0f);
  }
}

}  // namespace
}  // namespace hwsim::pipeline
