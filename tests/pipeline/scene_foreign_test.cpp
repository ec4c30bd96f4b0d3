// Files as other programs write them: correct but unusual, or wrong in a way that costs no picture.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "pipeline/gltf/gltf_loader.h"
#include "tests/pipeline/scene_glb.h"

namespace hwsim::pipeline {
namespace {
using nlohmann::json;
using test::Bytes;
using test::GlbBuilder;
using test::TemporaryFolder;

class ForeignScene : public testing::Test {
 protected:
  TemporaryFolder folder{std::string("foreign_") +
                         testing::UnitTest::GetInstance()->current_test_info()->name()};

  Scene load(GlbBuilder glb) { return load_gltf(folder.write("scene.glb", glb.bytes())); }
  /// The JSON as text, with the bytes in a file beside it.
  Scene load_text(GlbBuilder glb, const std::function<void(std::string&)>& edit) {
    glb.bytes();
    glb.root["buffers"][0]["uri"] = "scene.bin";
    folder.write("scene.bin", glb.bin);
    std::string text = glb.root.dump();
    edit(text);
    return load_gltf(folder.write("scene.gltf", Bytes(text.begin(), text.end())));
  }
  Diagnostic error_of(const std::function<void()>& load_it) {
    try {
      load_it();
    } catch (const InputError& e) {
      return e.diagnostics().front();
    }
    return {};
  }
};

bool has_note(const Scene& scene, const std::string& code, const std::string& part) {
  for (const Diagnostic& d : scene.notes)
    if (d.code == code && d.message.find(part) != std::string::npos) return true;
  return false;
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
}

GlbBuilder square_with_material() {
  GlbBuilder glb = test::square_glb();
  glb.root["materials"] = {{{"name", "first"}}, {{"name", "second"}}};
  glb.primitive()["material"] = 1;
  return glb;
}

TEST_F(ForeignScene, WholeNumbersMayBeWrittenAsFractionsAndPowers) {
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"\"material\":1", "\"material\":1.0"},
           {"\"mesh\":0", "\"mesh\":0.0"},
           {"\"indices\":2", "\"indices\":2e0"},
           {"\"byteOffset\":48", "\"byteOffset\":4.8e1"},
           {"\"byteLength\":48", "\"byteLength\":480e-1"},
           {"\"componentType\":5123", "\"componentType\":5.123e3"},
           {"\"count\":6", "\"count\":6.000"},
           {"\"scene\":0", "\"scene\":0.0"},
           {"\"nodes\":[0]", "\"nodes\":[0.0]"}}) {
    const Scene scene = load_text(square_with_material(),
                                  [&, &f = from, &t = to](std::string& text) { replace(text, f, t); });
    ASSERT_EQ(scene.meshes.size(), 1u) << to;
    EXPECT_EQ(scene.meshes[0].indices, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3})) << to;
    EXPECT_EQ(scene.materials[static_cast<std::size_t>(scene.meshes[0].parts[0].material)].name, "second")
        << to;
  }
}

TEST_F(ForeignScene, NumbersThatAreNotWholeAreRefusedWithTheirPlace) {
  const Diagnostic d = error_of([&] {
    load_text(square_with_material(),
              [](std::string& text) { replace(text, "\"material\":1", "\"material\":0.5"); });
  });
  EXPECT_EQ(d.code, "S004");
  EXPECT_NE(d.message.find("meshes[0].primitives[0].material is 0.5"), std::string::npos) << d.message;
  EXPECT_FALSE(d.help.empty());
}

TEST_F(ForeignScene, MatricesMayMissTheLastRowByRounding) {
  GlbBuilder glb = test::square_glb();
  glb.root["nodes"][0]["matrix"] = {2, 0, 0, 1e-7, 0, 1, 0, 0, 0, 0, 1, 0, 0.5, 0, 0, 0.9999999};
  const Scene scene = load(glb);
  EXPECT_EQ(scene.instances[0].world_from_local[0], glm::vec4(2, 0, 0, 0));
  EXPECT_EQ(scene.instances[0].world_from_local[3], glm::vec4(0.5f, 0, 0, 1));
  glb.root["nodes"][0]["matrix"][15] = 0.5;
  EXPECT_EQ(error_of([&] { load(glb); }).code, "S010");
  glb.root["nodes"][0]["matrix"] = {1, 0, 0, 0.01, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_EQ(error_of([&] { load(glb); }).code, "S010");
}

// Takes whole groups of three bytes.
std::string base64(const Bytes& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i + 2 < bytes.size(); i += 3) {
    const std::uint32_t word =
        std::uint32_t{bytes[i]} << 16 | std::uint32_t{bytes[i + 1]} << 8 | bytes[i + 2];
    for (const int shift : {18, 12, 6, 0}) out += digits[word >> shift & 63];
  }
  return out;
}

TEST_F(ForeignScene, ABinChunkMayBeEmpty) {
  GlbBuilder glb = test::square_glb();
  glb.bytes();
  const Bytes data = glb.bin;
  ASSERT_EQ(data.size() % 3, 0u);
  glb.root["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(data);
  Bytes file = test::assemble_glb(glb.root.dump(), {});
  test::append_u32(file, 0);
  test::append_u32(file, 0x004E4942);
  for (std::size_t i = 0; i < 4; ++i) file[8 + i] = static_cast<std::uint8_t>(file.size() >> (8 * i));
  EXPECT_EQ(stats(load_gltf(folder.write("scene.glb", file))).drawn_triangles, 2u);
}

TEST_F(ForeignScene, UrisAreDecodedOnceAndByOneRule) {
  const std::vector<std::pair<std::string, std::string>> uri_and_file = {
      {"a+b.bin", "a+b.bin"},
      {"a%2Bc.bin", "a+c.bin"},
      {"a%20d.bin", "a d.bin"},
      {"a e.bin", "a e.bin"},
      {"100%.bin", "100%.bin"},
      {"%zz.bin", "%zz.bin"},
      {"f%2525.bin", "f%25.bin"},
      {"./g.bin", "g.bin"},
      {"x/../h.bin", "h.bin"},
      {"%C3%A9.bin", "\xC3\xA9.bin"},
      {"raw%20name.bin", "raw%20name.bin"}};
  GlbBuilder glb = test::square_glb();
  glb.bytes();
  for (const auto& [uri, file] : uri_and_file) {
    folder.write(file, glb.bin);
    glb.root["buffers"][0]["uri"] = uri;
    const std::string text = glb.root.dump();
    EXPECT_EQ(stats(load_gltf(folder.write("scene.gltf", Bytes(text.begin(), text.end())))).drawn_triangles,
              2u)
        << uri;
    std::filesystem::remove(folder.path() + "/" + file);
  }
}

TEST_F(ForeignScene, SparseAccessorsNeedNoBase) {
  GlbBuilder glb = test::square_glb();
  const int places = glb.add_view<std::uint16_t>({1, 2, 3, 4, 5}),
            values = glb.add_view<std::uint16_t>({1, 2, 2, 1, 3});
  json& accessor = glb.root["accessors"][2];
  accessor.erase("bufferView");
  accessor["sparse"] = {{"count", 5},
                        {"indices", {{"bufferView", places}, {"componentType", 5123}}},
                        {"values", {{"bufferView", values}}}};
  EXPECT_EQ(load(glb).meshes.at(0).indices, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3}));
}

TEST_F(ForeignScene, BuffersThatNothingDrawnRefersToMayBeMissing) {
  GlbBuilder glb = test::square_glb();
  glb.bytes();
  glb.root["buffers"].push_back({{"byteLength", 16}});
  glb.root["buffers"].push_back({{"byteLength", 16}, {"uri", "lost.bin"}});
  glb.root["bufferViews"].push_back({{"buffer", 2}, {"byteLength", 16}});
  const Scene scene = load(glb);
  EXPECT_EQ(stats(scene).drawn_triangles, 2u);
  EXPECT_TRUE(has_note(scene, "S119", "buffers[1] and 1 more"));
  glb.root["bufferViews"][0]["buffer"] = 1;
  glb.root["buffers"][1]["byteLength"] = 48;
  EXPECT_EQ(error_of([&] { load(glb); }).code, "S007");
}

TEST_F(ForeignScene, CompressionThatIsNotListedAsRequiredIsNamed) {
  GlbBuilder draco = test::square_glb();
  for (json& accessor : draco.root["accessors"]) accessor.erase("bufferView");
  draco.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0},
                                                                   {"attributes", {{"POSITION", 0}}}};
  const Diagnostic d = error_of([&] { load(draco); });
  EXPECT_EQ(d.code, "S006");
  EXPECT_NE(d.message.find("meshes[0].primitives[0] is compressed by KHR_draco_mesh_compression"),
            std::string::npos);
  EXPECT_NE(d.help.find("without Draco"), std::string::npos);

  GlbBuilder meshopt = test::square_glb();
  meshopt.bytes();
  meshopt.root["buffers"].push_back({{"byteLength", 48}});
  meshopt.root["bufferViews"][0] = {
      {"buffer", 1}, {"byteLength", 48}, {"extensions", {{"EXT_meshopt_compression", {{"buffer", 0}}}}}};
  const Diagnostic m = error_of([&] { load(meshopt); });
  EXPECT_EQ(m.code, "S006");
  EXPECT_NE(m.message.find("EXT_meshopt_compression"), std::string::npos);
}

TEST_F(ForeignScene, IntegerColorsAndCoordinatesAreFractionsEvenWithoutTheFlag) {
  GlbBuilder glb = test::square_glb();
  const std::vector<std::uint8_t> colors = {51, 0, 0, 255, 0, 51, 0, 255, 0, 0, 51, 255, 255, 255, 255, 255};
  glb.primitive()["attributes"]["COLOR_0"] = glb.add_accessor<std::uint8_t>(colors, 5121, "VEC4", 4);
  glb.primitive()["attributes"]["TEXCOORD_0"] =
      glb.add_accessor<std::uint16_t>({0, 0, 65535, 0, 0, 65535, 65535, 65535}, 5123, "VEC2", 2);
  const Scene scene = load(glb);
  EXPECT_EQ(scene.meshes[0].colors[0], glm::vec4(0.2f, 0, 0, 1));
  EXPECT_EQ(scene.meshes[0].uv0[3], glm::vec2(1, 1));
  EXPECT_TRUE(has_note(scene, "S121", "colors"));
  EXPECT_TRUE(has_note(scene, "S121", "texture coordinates"));
  glb.root["extensionsUsed"] = {"KHR_mesh_quantization"};  // which allows whole coordinates, but not colors
  const Scene quantized = load(glb);
  EXPECT_EQ(quantized.meshes[0].uv0[3], glm::vec2(65535, 65535));
  EXPECT_EQ(quantized.meshes[0].colors[0], glm::vec4(0.2f, 0, 0, 1));
}

TEST_F(ForeignScene, ASkinnedMeshDoesNotMoveWithItsNode) {
  GlbBuilder glb = test::square_glb();
  glb.root["nodes"][0]["translation"] = {0, 1, 0};
  glb.root["nodes"][0]["skin"] = 0;
  glb.root["nodes"].push_back({{"children", {0}}, {"translation", {1, 0, 0}}});
  glb.root["nodes"].push_back({{"name", "joint"}});
  glb.root["skins"] = {{{"joints", {2}}}};
  glb.root["scenes"][0]["nodes"] = {1, 2};
  const Scene scene = load(glb);
  EXPECT_EQ(scene.instances.at(0).world_from_local, glm::mat4(1.0f));
  EXPECT_TRUE(has_note(scene, "S110", "the meshes' nodes do not"));
}

// An armature in centimeters below a node of a hundredth, and a mesh as modeled in them.
GlbBuilder skinned_square(double second_joint_x) {
  GlbBuilder glb = test::square_glb();
  const std::vector<float> inverse = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,   // the first joint's
                                      1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -5, 0, 0, 1};  // and the second
  const int matrices = glb.add_accessor(inverse, 5126, "MAT4", 16);
  glb.root["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"scale", {7, 7, 7}}},
                       {{"name", "armature"}, {"scale", {0.01, 0.01, 0.01}}, {"children", {2}}},
                       {{"name", "hip"}, {"children", {3}}},
                       {{"name", "knee"}, {"translation", {second_joint_x, 0, 0}}}};
  glb.root["skins"] = {{{"joints", {2, 3.0}}, {"inverseBindMatrices", matrices}}};
  glb.root["scenes"][0]["nodes"] = {0, 1};
  return glb;
}

TEST_F(ForeignScene, JointsPlaceASkinnedMesh) {
  const Scene scene = load(skinned_square(5));
  const SceneStats s = stats(scene);
  EXPECT_NEAR((s.bounds_max.x - s.bounds_min.x) * scene.meters_per_unit, 0.01, 1e-8);
  EXPECT_FALSE(has_note(scene, "S110", "not bent"));
  EXPECT_TRUE(has_note(load(skinned_square(6)), "S110", "not bent"));
}

TEST_F(ForeignScene, AWrongSkinCostsNoScene) {
  for (const json& skin : std::vector<json>{json::object(),
                                            {{"joints", {77}}},
                                            {{"joints", {0.5}}},
                                            {{"joints", "all"}},
                                            {{"joints", {2}}, {"inverseBindMatrices", 0}},
                                            {{"joints", {2, 3, 1}}, {"inverseBindMatrices", 3}}}) {
    GlbBuilder glb = skinned_square(5);
    glb.root["skins"] = json::array({skin});  // {skin} is a copy to clang
    const Scene scene = load(glb);
    EXPECT_EQ(stats(scene).drawn_triangles, 2u) << skin;
    EXPECT_TRUE(has_note(scene, "S110", "drawn as modeled")) << skin;
  }
}

TEST_F(ForeignScene, ARadiusOfAnotherProgramIsIgnored) {
  GlbBuilder glb = test::square_glb();
  glb.add_attribute("_RADIUS", {1, 1, 1, -1}, "SCALAR", 1);
  glb.add_attribute("TANGENT", {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4", 4);
  const Scene scene = load(glb);
  EXPECT_TRUE(scene.meshes[0].radius.empty());
  EXPECT_EQ(scene.meshes[0].positions, load(test::square_glb()).meshes[0].positions);
  EXPECT_TRUE(has_note(scene, "S109", "_RADIUS"));
}

GlbBuilder two_cameras(const json& bad) {
  GlbBuilder glb = test::square_glb();
  glb.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}, bad};
  glb.root["nodes"].push_back({{"camera", 0}, {"name", "good"}});
  glb.root["nodes"].push_back({{"camera", 1}, {"name", "bad"}});
  glb.root["scenes"][0]["nodes"] = {0, 1, 2};
  return glb;
}

TEST_F(ForeignScene, AWrongCameraIsLeftOutAndNotTheFile) {
  for (const json& bad : std::vector<json>{
           {{"type", "perspective"}, {"perspective", {{"yfov", 45}, {"znear", 0.1}}}},
           {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0}}}},
           {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 5}, {"zfar", 1}}}},
           {{"type", "perspective"}, {"perspective", {{"yfov", "wide"}, {"znear", 0.1}}}},
           {{"type", "perspective"}},
           {{"type", "orthographic"},
            {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", -100}, {"zfar", 9}}}},
           {{"type", "orthographic"},
            {"orthographic", {{"xmag", 1}, {"ymag", 0}, {"znear", 0}, {"zfar", 9}}}},
           {{"type", "fisheye"}},
           json::object(),
           7}) {
    const Scene scene = load(two_cameras(bad));
    ASSERT_EQ(scene.cameras.size(), 1u) << bad;
    EXPECT_EQ(scene.cameras[0].name, "good");
    EXPECT_TRUE(has_note(scene, "S115", "a camera is left out")) << bad;
  }
  const json good = {{"type", "orthographic"},
                     {"orthographic", {{"xmag", 3}, {"ymag", 1}, {"znear", 0}, {"zfar", 9}}}};
  const Scene scene = load(two_cameras(good));
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[1].aspect_ratio, 3.0f);
}

TEST_F(ForeignScene, AnAspectRatioThatIsNoneIsSaid) {
  for (const json& aspect : std::vector<json>{0, -1.5, 1e-9, 1e9, "wide", nullptr}) {
    const Scene scene =
        load(two_cameras({{"type", "perspective"},
                          {"perspective", {{"yfov", 0.8}, {"znear", 0.1}, {"aspectRatio", aspect}}}}));
    ASSERT_EQ(scene.cameras.size(), 2u) << aspect;
    EXPECT_EQ(scene.cameras[1].aspect_ratio, 0.0f);
    EXPECT_TRUE(has_note(scene, "S115", "perspective.aspectRatio is " + aspect.dump())) << aspect;
    EXPECT_TRUE(has_note(scene, "S115", "(cameras[1])")) << aspect;
  }
}

TEST_F(ForeignScene, ANearPlaneThatLeavesNoDepthIsSaid) {
  const auto with_near = [&](double near) {
    GlbBuilder glb =
        two_cameras({{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", near}}}});
    glb.root["nodes"][2]["translation"] = {0, 0, 4};
    return load(glb);
  };
  EXPECT_TRUE(has_note(with_near(1e-9), "S123", "near plane"));
  EXPECT_FALSE(has_note(with_near(1e-4), "S123", "near plane"));
}

TEST_F(ForeignScene, ASpotLightNeedsNoAngles) {
  GlbBuilder glb = test::square_glb();
  glb.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  glb.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"intensity", 2}}};
  const Scene scene = load(glb);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].kind, LightKind::spot);
  EXPECT_FLOAT_EQ(scene.lights[0].outer_cone_rad, 0.785398f);
  EXPECT_FALSE(has_note(scene, "S113", "spot"));
}

TEST_F(ForeignScene, TheCameraFrameIsSeenWhole) {
  for (const bool orthographic : {false, true}) {
    Camera camera;
    camera.orthographic = orthographic;
    camera.aspect_ratio = 3.0f;
    for (const float image : {0.5f, 16.0f / 9.0f, 3.0f, 5.0f}) {
      const glm::mat4 clip = clip_from_view(camera, image);
      const float top = orthographic ? 1.0f : 10.0f * std::tan(0.5f * camera.fov_y_rad);
      const glm::vec4 corner = clip * glm::vec4(3.0f * top, top, -10.0f, 1);
      EXPECT_LE(std::abs(corner.x / corner.w), 1.0001f) << image;
      EXPECT_LE(std::abs(corner.y / corner.w), 1.0001f) << image;
      EXPECT_GE(std::max(corner.x, corner.y) / corner.w, 0.9999f) << image;
    }
  }
  Camera camera;
  camera.aspect_ratio = 1.7778f;  // 16:9 as some exporters round it
  EXPECT_EQ(clip_from_view(camera, 16.0f / 9.0f), clip_from_view(Camera{}, 16.0f / 9.0f));
}

TEST_F(ForeignScene, ExtensionsAreReadInAnyCase) {
  EXPECT_EQ(stats(load_gltf(folder.write("SCENE.GLB", test::square_glb().bytes()))).drawn_triangles, 2u);
}

}  // namespace
}  // namespace hwsim::pipeline
