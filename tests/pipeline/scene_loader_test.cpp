#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "pipeline/gltf/gltf_loader.h"
#include "tests/pipeline/scene_glb.h"

namespace hwsim::pipeline {
namespace {
using nlohmann::json;
using test::GlbBuilder;
using test::TemporaryFolder;

class SceneLoader : public testing::Test {
 protected:
  TemporaryFolder folder{std::string("loader_") +
                         testing::UnitTest::GetInstance()->current_test_info()->name()};

  Scene load(GlbBuilder glb, const SceneLoadOptions& options = {}) {
    return load_gltf(folder.write("scene.glb", glb.bytes()), options);
  }
  // The first error's code; "" if it loads.
  std::string error_code(GlbBuilder glb, const SceneLoadOptions& options = {}) {
    try {
      load(std::move(glb), options);
      return "";
    } catch (const InputError& e) {
      return e.diagnostics().front().code;
    }
  }
};

bool has_note(const Scene& scene, const std::string& code, const std::string& part) {
  for (const Diagnostic& d : scene.notes)
    if (d.code == code && d.message.find(part) != std::string::npos) return true;
  return false;
}

std::vector<std::uint32_t> drawn_vertices(const Scene& scene) { return scene.meshes.at(0).indices; }

TEST_F(SceneLoader, ReadsASquareWithDefaultsForTheRest) {
  const Scene scene = load(test::square_glb());
  ASSERT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.meshes[0].positions.size(), 4u);
  EXPECT_EQ(drawn_vertices(scene), (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3}));
  EXPECT_EQ(scene.meshes[0].index_bytes, 2);
  EXPECT_EQ(scene.meshes[0].vertex_bytes, 24);
  EXPECT_EQ(scene.meshes[0].bounds_max, glm::vec3(1, 1, 0));
  EXPECT_EQ(scene.materials.at(static_cast<std::size_t>(scene.meshes[0].parts[0].material)).name, "default");
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_TRUE(scene.lights[0].casts_shadow);
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_TRUE(has_note(scene, "S117", "sun"));
  EXPECT_EQ(scene.content_hash.size(), 32u);
}

TEST_F(SceneLoader, DefaultCameraSeesEveryCorner) {
  auto glb = test::square_glb();
  glb.root["nodes"][0]["translation"] = {100, -7, 3};
  glb.root["nodes"][0]["scale"] = {20, 3, 1};
  const Scene scene = load(glb);
  const SceneStats s = stats(scene);
  const glm::mat4 clip = clip_from_view(scene.cameras[0], 1.0f) * scene.cameras[0].view_from_world;
  for (const glm::vec3 p : {s.bounds_min, s.bounds_max}) {
    const glm::vec4 c = clip * glm::vec4(p, 1);
    EXPECT_LT(std::abs(c.x), c.w);
    EXPECT_LT(std::abs(c.y), c.w);
    EXPECT_GT(c.z, 0.0f);
    EXPECT_LT(c.z, c.w);
  }
}

TEST_F(SceneLoader, StripsAlternateTheirWindingAndFansShareTheFirstVertex) {
  auto strip = test::square_glb();
  strip.primitive().erase("indices");
  strip.primitive()["mode"] = 5;
  EXPECT_EQ(drawn_vertices(load(strip)), (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}));
  auto fan = strip;
  fan.primitive()["mode"] = 6;
  EXPECT_EQ(drawn_vertices(load(fan)), (std::vector<std::uint32_t>{1, 2, 0, 2, 3, 0}));
}

TEST_F(SceneLoader, PointsAndLinesDrawNothingButAreNoted) {
  for (const int mode : {0, 1, 2, 3}) {
    auto glb = test::square_glb();
    glb.primitive()["mode"] = mode;
    const Scene scene = load(glb);
    EXPECT_EQ(stats(scene).drawn_triangles, 0u);
    EXPECT_TRUE(has_note(scene, "S103", "points and lines"));
  }
}

TEST_F(SceneLoader, IndicesOfEveryWidthGiveTheSameTriangles) {
  auto bytes = test::square_glb();
  bytes.primitive()["indices"] = bytes.add_accessor<std::uint8_t>({0, 1, 2, 2, 1, 3}, 5121, "SCALAR", 1);
  auto words = test::square_glb();
  words.primitive()["indices"] = words.add_accessor<std::uint32_t>({0, 1, 2, 2, 1, 3}, 5125, "SCALAR", 1);
  const Scene narrow = load(bytes), wide = load(words);
  EXPECT_EQ(drawn_vertices(narrow), drawn_vertices(wide));
  EXPECT_EQ(narrow.meshes[0].index_bytes, 1);
  EXPECT_EQ(wide.meshes[0].index_bytes, 4);
}

TEST_F(SceneLoader, NormalizedIntegersAreDividedByTheirMaximum) {
  auto glb = test::square_glb();
  const int accessor = glb.add_accessor<std::int16_t>(
      {-32768, 0, 0, 32767, 0, 0, 0, 16384, 0, 32767, 32767, 0}, 5122, "VEC3", 3);
  glb.root["accessors"][static_cast<std::size_t>(accessor)]["normalized"] = true;
  glb.primitive()["attributes"]["POSITION"] = accessor;
  const Scene scene = load(glb);
  EXPECT_EQ(scene.meshes[0].positions[0].x, -1.0f);  // -32768 is clamped
  EXPECT_EQ(scene.meshes[0].positions[1].x, 1.0f);
  EXPECT_FLOAT_EQ(scene.meshes[0].positions[2].y, 16384.0f / 32767.0f);
}

TEST_F(SceneLoader, StridesSkipWhatLiesBetweenElements) {
  auto glb = test::square_glb();
  std::vector<float> padded;
  const auto packed = test::square_positions();
  for (std::size_t v = 0; v < 4; ++v) {
    padded.insert(padded.end(), packed.begin() + static_cast<int>(3 * v),
                  packed.begin() + static_cast<int>(3 * v + 3));
    padded.insert(padded.end(), {99, 98});
  }
  glb.primitive()["attributes"]["POSITION"] = glb.add_accessor(padded, 5126, "VEC3", 5, 20);
  EXPECT_EQ(load(glb).meshes[0].positions, load(test::square_glb()).meshes[0].positions);
}

TEST_F(SceneLoader, SparseValuesReplaceElements) {
  auto glb = test::square_glb();
  const int indices = glb.add_view<std::uint8_t>({1, 3}), values = glb.add_view<float>({5, 6, 7, 8, 9, 10});
  glb.root["accessors"][0]["sparse"] = {{"count", 2},
                                        {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                        {"values", {{"bufferView", values}}}};
  const auto positions = load(glb).meshes[0].positions;
  EXPECT_EQ(positions[0], glm::vec3(0, 0, 0));
  EXPECT_EQ(positions[1], glm::vec3(5, 6, 7));
  EXPECT_EQ(positions[3], glm::vec3(8, 9, 10));
  glb.root["accessors"][0]["count"] = 3;  // sparse index 3 is now outside
  EXPECT_EQ(error_code(glb), "S009");
}

TEST_F(SceneLoader, MissingNormalsSplitTheTriangles) {
  auto glb = test::square_glb();
  glb.primitive()["attributes"].erase("NORMAL");
  const Scene scene = load(glb);
  EXPECT_EQ(scene.meshes[0].positions.size(), 6u);
  for (const glm::vec3& n : scene.meshes[0].normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
  EXPECT_TRUE(has_note(scene, "S106", "normals"));
}

TEST_F(SceneLoader, WrongNormalsAreRepaired) {
  auto glb = test::square_glb();
  glb.add_attribute("NORMAL", {0, 0, 5, 0, 0, 0, 0, 0, 0.5f, 0, 0, 1}, "VEC3", 3);
  const Scene scene = load(glb);
  for (const glm::vec3& n : scene.meshes[0].normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
  EXPECT_TRUE(has_note(scene, "S107", "normals"));
}

TEST_F(SceneLoader, PrimitivesThatShareVerticesStoreThemOnce) {
  auto glb = test::square_glb();
  const json second = glb.primitive();
  glb.root["meshes"][0]["primitives"].push_back(second);
  const Scene scene = load(glb);
  EXPECT_EQ(scene.meshes[0].positions.size(), 4u);
  ASSERT_EQ(scene.meshes[0].parts.size(), 2u);
  EXPECT_EQ(stats(scene).drawn_triangles, 4u);
}

TEST_F(SceneLoader, NodesMultiplyFromTheRootAndMayMirror) {
  auto glb = test::square_glb();
  glb.root["nodes"] = {
      {{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}},
      {{"mesh", 0}, {"scale", {-2, 1, 1}}, {"translation", {1, 0, 0}}}};
  const Scene scene = load(glb);
  const glm::vec4 p =
      scene.instances.at(0).world_from_local * glm::vec4(1, 0, 0, 1);  // (-2+1, 0) turned by 90 degrees
  EXPECT_NEAR(p.x + scene.origin_m.x, 10.0, 1e-6);  // far for a square of a meter: moved while it was loaded
  EXPECT_NEAR(p.y, -1.0f, 1e-6f);
  EXPECT_LT(glm::determinant(glm::mat3(scene.instances[0].world_from_local)), 0.0f);
}

TEST_F(SceneLoader, LongNodeChainsLoadAndCyclesAreErrors) {
  constexpr int kLength = 20000;
  auto glb = test::square_glb();
  json& nodes = glb.root["nodes"];
  nodes = json::array();
  for (int i = 0; i + 1 < kLength; ++i)
    nodes.push_back({{"children", {i + 1}}, {"translation", {0.5, 0, 0}}});
  nodes.push_back({{"mesh", 0}});
  const Scene chain = load(glb);
  EXPECT_EQ(chain.instances.at(0).world_from_local[3].x + chain.origin_m.x, 0.5 * (kLength - 1));
  nodes.back()["children"] = {7};
  EXPECT_EQ(error_code(glb), "S011");
}

TEST_F(SceneLoader, WireRadiusComesWithItsAxis) {
  auto glb = test::square_glb();
  glb.add_attribute("_HWSIM_RADIUS", {0.1f, 0.2f, 0.3f, 0.4f}, "SCALAR", 1);
  EXPECT_TRUE(load(glb).meshes[0].radius.empty());  // no TANGENT: no axis
  glb.add_attribute("TANGENT", {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4", 4);
  const Scene scene = load(glb);
  EXPECT_EQ(scene.meshes[0].radius, (std::vector<float>{0.1f, 0.2f, 0.3f, 0.4f}));
  EXPECT_EQ(scene.meshes[0].tangents.size(), 4u);
  EXPECT_FLOAT_EQ(scene.meshes[0].bounds_max.z, 0.4f);  // the surface lies a radius off the positions
}

TEST_F(SceneLoader, ReadsLightsAndTheFirstDirectionalOneCastsShadows) {
  auto glb = test::square_glb();
  glb.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 5}, {"range", 12}},
      {{"type", "directional"}, {"color", {1, 0.5, 0}}, {"intensity", 2}},
      {{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}}};
  for (const int light : {0, 1, 1, 2}) {
    glb.root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    glb.root["scenes"][0]["nodes"].push_back(glb.root["nodes"].size() - 1);
  }
  glb.root["nodes"][2]["rotation"] = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // -z turns to -y
  const Scene scene = load(glb);
  ASSERT_EQ(scene.lights.size(), 4u);
  EXPECT_EQ(scene.lights[0].range_m, 12.0f);
  EXPECT_FALSE(scene.lights[0].casts_shadow);
  EXPECT_TRUE(scene.lights[1].casts_shadow);
  EXPECT_NEAR(scene.lights[1].direction.y, -1.0f, 1e-6f);
  EXPECT_EQ(scene.lights[1].color, glm::vec3(2, 1, 0));
  EXPECT_FALSE(scene.lights[2].casts_shadow);
  EXPECT_EQ(scene.lights[3].outer_cone_rad, 0.5f);
}

TEST_F(SceneLoader, ReadsMaterialsWithTheirExtensions) {
  auto glb = test::square_glb();
  glb.root["materials"] = {
      {{"alphaMode", "MASK"},
       {"alphaCutoff", 0.25},
       {"doubleSided", true},
       {"emissiveFactor", {1, 0.5, 0}},
       {"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"roughnessFactor", 3}}},
       {"extensions",
        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}},
         {"KHR_materials_unlit", json::object()}}}}};
  glb.primitive()["material"] = 0;
  const Scene scene = load(glb);
  const Material& m = scene.materials[0];
  EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(m.alpha_cutoff, 0.25f);
  EXPECT_EQ(m.emissive, glm::vec3(4, 2, 0));
  EXPECT_EQ(m.base_color, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.roughness, 1.0f);
  EXPECT_TRUE(has_note(scene, "S111", "clamped"));
  EXPECT_EQ(m.model, ShadingModel::unlit);
  EXPECT_EQ(stats(scene).drawn_mask_triangles, 2u);
}

TEST_F(SceneLoader, NamesUnsupportedExtensions) {
  auto glb = test::square_glb();
  glb.root["extensionsUsed"] = {"KHR_materials_clearcoat"};
  EXPECT_TRUE(has_note(load(glb), "S101", "KHR_materials_clearcoat"));
  glb.root["extensionsRequired"] = {"KHR_materials_clearcoat"};
  EXPECT_EQ(error_code(glb), "S006");
}

TEST_F(SceneLoader, LimitsAreCheckedBeforeMemoryIsTaken) {
  auto glb = test::square_glb();
  SceneLoadOptions options;
  options.max_drawn_triangles = 2;
  EXPECT_EQ(error_code(glb, options), "");
  glb.root["nodes"].push_back({{"mesh", 0}});
  glb.root["scenes"][0]["nodes"].push_back(1);
  EXPECT_EQ(error_code(glb, options), "S012");
  options = {};
  options.max_file_bytes = 100;
  EXPECT_EQ(error_code(glb, options), "S012");
  auto copies = test::square_glb();  // 3 x 2^24 vertices from no bytes at all
  copies.root["accessors"].push_back({{"componentType", 5126}, {"count", 1 << 24}, {"type", "VEC3"}});
  for (int i = 0; i < 3; ++i) {
    copies.root["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 3}}}}}}});
    copies.root["nodes"].push_back({{"mesh", i + 1}});
    copies.root["scenes"][0]["nodes"].push_back(i + 1);
  }
  EXPECT_EQ(error_code(copies), "S012");
  auto zeros = test::square_glb();  // all zeros by definition, and no byte of the file
  zeros.root["accessors"][0].erase("bufferView");
  zeros.root["accessors"][0]["count"] = 4000000000u;
  EXPECT_EQ(error_code(zeros), "S012");
}

TEST_F(SceneLoader, HashChangesWithAnyByte) {
  auto glb = test::square_glb();
  std::set<std::string> hashes = {load(glb).content_hash};
  for (std::size_t i = 0; i < 48; ++i) {
    auto changed = glb;
    changed.bin[i] ^= 1;  // the lowest bits of positions: still finite
    EXPECT_TRUE(hashes.insert(load(changed).content_hash).second) << i;
  }
  EXPECT_EQ(load(glb).content_hash, load(glb).content_hash);
}

TEST_F(SceneLoader, ExternalFilesAreFoundBesideTheSceneOnly) {
  auto glb = test::square_glb();
  glb.bytes();
  const test::Bytes longer = [&] {
    auto b = glb.bin;
    b.resize(b.size() + 10);  // glTF allows a longer file
    return b;
  }();
  folder.write("a b.bin", longer);
  glb.root["buffers"][0]["uri"] = "a%20b.bin";
  const std::string text = glb.root.dump();
  const std::string path = folder.write("scene.gltf", test::Bytes(text.begin(), text.end()));
  EXPECT_EQ(stats(load_gltf(path)).drawn_triangles, 2u);
  folder.write("a b.bin", test::Bytes(glb.bin.begin(), glb.bin.end() - 1));
  EXPECT_THROW(load_gltf(path), InputError);
  std::filesystem::remove(folder.path() + "/a b.bin");
  EXPECT_THROW(load_gltf(path), InputError);
  EXPECT_THROW(load_gltf(folder.path() + "/nothing.glb"), InputError);
  EXPECT_THROW(load_gltf(folder.path()), InputError);
}

TEST(SceneCamera, DepthIsZeroAtNearAndOneAtFar) {
  Camera camera;
  camera.near_m = 0.5f;
  camera.far_m = 20.0f;
  for (const bool orthographic : {false, true}) {
    camera.orthographic = orthographic;
    const glm::mat4 clip = clip_from_view(camera, 16.0f / 9.0f);
    const glm::vec4 near = clip * glm::vec4(0, 0, -0.5f, 1), far = clip * glm::vec4(0, 0, -20.0f, 1);
    EXPECT_NEAR(near.z / near.w, 0.0f, 1e-6f);
    EXPECT_NEAR(far.z / far.w, 1.0f, 1e-6f);
    const float top = orthographic ? 1.0f : 10.0f * std::tan(0.5f * camera.fov_y_rad);
    const glm::vec4 edge = clip * glm::vec4(top * 16.0f / 9.0f, top, -10.0f, 1);
    EXPECT_NEAR(edge.x / edge.w, 1.0f, 1e-5f);
    EXPECT_NEAR(edge.y / edge.w, 1.0f, 1e-5f);
  }
}

}  // namespace
}  // namespace hwsim::pipeline
