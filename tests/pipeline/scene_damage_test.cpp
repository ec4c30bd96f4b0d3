// Hostile and damaged files: each must end in an InputError or a scene, never in a crash.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "pipeline/gltf/gltf_loader.h"
#include "pipeline/open/scene_check.h"
#include "pipeline/open/scene_source.h"
#include "tests/pipeline/scene_glb.h"

namespace hwsim::pipeline {
namespace {
using nlohmann::json;
using test::Bytes;
using test::GlbBuilder;
using test::TemporaryFolder;

std::string outcome(const std::string& path) {
  try {
    const Scene scene = load_gltf(path);
    for (const Mesh& mesh : scene.meshes)
      for (const std::uint32_t index : mesh.indices) EXPECT_LT(index, mesh.positions.size());
    return "loads";
  } catch (const InputError& e) {
    return e.diagnostics().front().code;
  }
}

struct Damage {
  const char* name;
  const char* code;
  std::function<void(GlbBuilder&)> apply;
};

const std::vector<Damage>& damages() {
  static const std::vector<Damage> list = {
      {"index past the vertices", "S009",
       [](GlbBuilder& g) {
         g.primitive()["indices"] = g.add_accessor<std::uint16_t>({0, 1, 4}, 5123, "SCALAR", 1);
       }},
      {"signed indices", "S004",
       [](GlbBuilder& g) {
         g.primitive()["indices"] = g.add_accessor<std::int16_t>({0, 1, 2}, 5122, "SCALAR", 1);
       }},
      {"float indices", "S004",
       [](GlbBuilder& g) {
         g.primitive()["indices"] = g.add_accessor<float>({0, 1, 2}, 5126, "SCALAR", 1);
       }},
      {"two-dimensional positions", "S004",
       [](GlbBuilder& g) {
         g.add_attribute("POSITION", {0, 0, 1, 1, 2, 2, 3, 3}, "VEC2", 2);
       }},
      {"NaN position", "S010",
       [](GlbBuilder& g) {
         g.add_attribute("POSITION", {0, 0, 0, 1, 0, 0, 0, NAN, 0, 1, 1, 0}, "VEC3", 3);
       }},
      {"infinite normal", "S010",
       [](GlbBuilder& g) {
         g.add_attribute("NORMAL", {0, 0, 1, 0, 0, 1, 0, INFINITY, 0, 1, 1, 0}, "VEC3", 3);
       }},
      {"too few normals", "S009",
       [](GlbBuilder& g) {
         g.add_attribute("NORMAL", {0, 0, 1}, "VEC3", 3);
       }},
      {"accessor past its view", "S008", [](GlbBuilder& g) { g.root["accessors"][0]["count"] = 5; }},
      {"offset past its view", "S008", [](GlbBuilder& g) { g.root["accessors"][0]["byteOffset"] = 4; }},
      {"offset that wraps", "S008",
       [](GlbBuilder& g) { g.root["accessors"][0]["byteOffset"] = 9007199254740000u; }},
      {"offset above 2^53", "S004",
       [](GlbBuilder& g) { g.root["accessors"][0]["byteOffset"] = 18446744073709551600u; }},
      {"negative offset", "S004", [](GlbBuilder& g) { g.root["accessors"][0]["byteOffset"] = -4; }},
      {"count of zero", "S008", [](GlbBuilder& g) { g.root["accessors"][0]["count"] = 0; }},
      {"count that is no number", "S004", [](GlbBuilder& g) { g.root["accessors"][0]["count"] = "4"; }},
      {"view past the buffer", "S008", [](GlbBuilder& g) { g.root["bufferViews"][2]["byteLength"] = 1000; }},
      {"buffer longer than the chunk", "S007",
       [](GlbBuilder& g) {
         g.root["buffers"] = {{{"byteLength", 4096}}};
       }},
      {"second buffer without a uri", "S007",
       [](GlbBuilder& g) {
         g.root["buffers"] = {{{"byteLength", 108}}, {{"byteLength", 64}}};
         g.root["bufferViews"][0]["buffer"] = 1;
       }},
      {"empty data uri", "",
       [](GlbBuilder& g) {
         g.root["images"] = {{{"uri", "data:image/png;base64,"}}};
       }},
      {"unknown component type", "S004",
       [](GlbBuilder& g) { g.root["accessors"][0]["componentType"] = 5124; }},
      {"unknown type", "S004", [](GlbBuilder& g) { g.root["accessors"][0]["type"] = "VEC5"; }},
      {"stride below the element", "S008", [](GlbBuilder& g) { g.root["bufferViews"][0]["byteStride"] = 4; }},
      {"mode above 6", "S004", [](GlbBuilder& g) { g.primitive()["mode"] = 7; }},
      {"attribute index past the accessors", "S005",
       [](GlbBuilder& g) { g.primitive()["attributes"]["POSITION"] = 99; }},
      {"unused attribute past the accessors", "S005",
       [](GlbBuilder& g) { g.primitive()["attributes"]["_X"] = 99; }},
      {"material past the materials", "S005", [](GlbBuilder& g) { g.primitive()["material"] = 0; }},
      {"mesh past the meshes", "S005", [](GlbBuilder& g) { g.root["nodes"][0]["mesh"] = 1; }},
      {"child that does not exist", "S005", [](GlbBuilder& g) { g.root["nodes"][0]["children"] = {3}; }},
      {"node that is its own child", "S011", [](GlbBuilder& g) { g.root["nodes"][0]["children"] = {0}; }},
      {"the same root twice", "S011",
       [](GlbBuilder& g) {
         g.root["scenes"][0]["nodes"] = {0, 0};
       }},
      {"matrix of 15 numbers", "S004",
       [](GlbBuilder& g) {
         g.root["nodes"][0]["matrix"] = json::array({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0});
       }},
      {"projective matrix", "S010",
       [](GlbBuilder& g) {
         g.root["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
       }},
      {"scale that overflows", "S010",
       [](GlbBuilder& g) {
         g.root["nodes"][0]["scale"] = {1e300, 1e300, 1e300};
       }},
      {"no scenes", "S014", [](GlbBuilder& g) { g.root.erase("scenes"), g.root.erase("scene"); }},
      {"scene past the scenes", "S005", [](GlbBuilder& g) { g.root["scene"] = 1; }},
      {"version 1.0", "S014", [](GlbBuilder& g) { g.root["asset"]["version"] = "1.0"; }},
      {"light past the lights", "S005",
       [](GlbBuilder& g) { g.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0; }},
      {"camera without its values", "",
       [](GlbBuilder& g) {
         g.root["cameras"] = {{{"type", "perspective"}}}, g.root["nodes"][0]["camera"] = 0;
       }},
      {"camera of 360 degrees", "",
       [](GlbBuilder& g) {
         g.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 6.28}, {"znear", 0.1}}}}},
         g.root["nodes"][0]["camera"] = 0;
       }},
      {"alpha mode of another name", "S004",
       [](GlbBuilder& g) {
         g.root["materials"] = {{{"alphaMode", "HASH"}}};
       }},
      {"texture without an image", "",
       [](GlbBuilder& g) {
         g.root["textures"] = {json::object()}, g.root["materials"] = {{{"normalTexture", {{"index", 0}}}}},
         g.primitive()["material"] = 0;
       }},
  };
  return list;
}

TEST(SceneDamage, EachDamageGivesItsOwnError) {
  const TemporaryFolder folder("damage");
  for (const Damage& damage : damages()) {
    GlbBuilder glb = test::square_glb();
    damage.apply(glb);
    const std::string got = outcome(folder.write("scene.glb", glb.bytes()));
    if (*damage.code) {
      EXPECT_EQ(got, damage.code) << damage.name;
    }
  }
  EXPECT_EQ(outcome(folder.write("scene.glb", test::square_glb().bytes())), "loads");
}

TEST(SceneDamage, TextThatIsNoGltfIsRefused) {
  const TemporaryFolder folder("text");
  for (const std::string& text : {std::string(), std::string("{"), std::string("[]"), std::string("null"),
                                  std::string("{}"), std::string("{\"asset\":3}"), std::string(100000, '['),
                                  "{\"asset\":{\"version\":\"2.0\"},\"x\":" + std::string(100000, '{')})
    EXPECT_EQ(outcome(folder.write("scene.gltf", Bytes(text.begin(), text.end()))).front(), 'S')
        << text.substr(0, 40);
}

void set_u32(Bytes& bytes, std::size_t at, std::size_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

TEST(SceneDamage, AFileCutOffAnywhereIsRefused) {
  const TemporaryFolder folder("cut");
  const Bytes whole = test::square_glb().bytes();
  const std::size_t json_bytes = whole[12] + 256u * whole[13];
  for (std::size_t size = 0; size < whole.size(); ++size) {
    Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(outcome(folder.write("scene.glb", cut)), "S002") << size;
    if (size < 20) continue;
    set_u32(cut, 8, size);  // a header that agrees with the cut
    EXPECT_NE(outcome(folder.write("scene.glb", cut)), "loads") << size;
    const std::size_t body = 20 + json_bytes;
    if (size >= body + 8) set_u32(cut, body, size - body - 8);
    if (size < body) set_u32(cut, 12, size - 20);
    EXPECT_NE(outcome(folder.write("scene.glb", cut)), "loads") << size;
  }
}

TEST(SceneDamage, AnyByteReplacedNeverCrashes) {
  const TemporaryFolder folder("bytes");
  const Bytes whole = test::square_glb().bytes();
  int loaded = 0;
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const int value : {0x00, 0x2d, 0x39, 0x5b, 0x7b, 0xff}) {
      Bytes changed = whole;
      changed[i] = static_cast<std::uint8_t>(value);
      loaded += outcome(folder.write("scene.glb", changed)) == "loads";
    }
  EXPECT_GT(loaded, 0);
}

TEST(SceneDamage, AGeneratedFileWithATextureSurvivesDamageToo) {
  const TemporaryFolder folder("generated");
  const std::string path = folder.path() + "/hall.glb";
  write_generated_scene("sponza_hall", {{"bays", 1}, {"detail", 3}, {"balusters", 1}}, path);
  std::ifstream in(path, std::ios::binary);
  const Bytes whole((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  for (std::size_t i = 0; i < whole.size(); i += 1009) {
    Bytes changed = whole;
    changed[i] = static_cast<std::uint8_t>(~changed[i]);
    outcome(folder.write("scene.glb", changed));
    EXPECT_EQ(outcome(folder.write("cut.glb",
                                   Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(i)))),
              "S002");
  }
}

TEST(SceneCheck, ListsCountsThenLossesThenRepairs) {
  const TemporaryFolder folder("check");
  GlbBuilder glb = test::square_glb();
  glb.root["extensionsUsed"] = {"KHR_materials_clearcoat"};
  glb.primitive()["attributes"].erase("NORMAL");
  const std::string path = folder.write("scene.glb", glb.bytes());
  const auto lines = check_scene(load_gltf(path), path);
  ASSERT_GT(lines.size(), 9u);
  EXPECT_EQ(lines[0].message, "2 triangles drawn (0 alpha-tested, 0 blended), 2 stored, 6 vertices");
  EXPECT_EQ(lines[8].code, "S101");
  EXPECT_NE(lines[8].message.find("KHR_materials_clearcoat"), std::string::npos);
  EXPECT_EQ(lines[9].code, "S106");
}

}  // namespace
}  // namespace hwsim::pipeline
