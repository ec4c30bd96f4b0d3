// What a file may reach and take: files below the scene's folder, and memory within a budget.
#include <gtest/gtest.h>

#include <functional>

#include "pipeline/gltf/gltf_loader.h"
#include "pipeline/gltf/uri.h"
#include "tests/pipeline/image/make_png.h"
#include "tests/pipeline/scene_glb.h"

namespace hwsim::pipeline {
namespace {
using nlohmann::json;
using test::Bytes;
using test::GlbBuilder;
using test::TemporaryFolder;
namespace fs = std::filesystem;

std::string error_code(const std::string& path, const SceneLoadOptions& options = {}) {
  try {
    load_gltf(path, options);
    return "";
  } catch (const InputError& e) {
    EXPECT_FALSE(e.diagnostics().front().help.empty());
    return e.diagnostics().front().code;
  }
}

std::string write_text(const TemporaryFolder& folder, const std::string& name, const json& root) {
  const std::string text = root.dump();
  return folder.write(name, Bytes(text.begin(), text.end()));
}

TEST(SceneFiles, NothingOutsideOfTheSceneFolderIsRead) {
  const TemporaryFolder folder("outside");
  fs::create_directories(folder.path() + "/scene/inner");
  fs::create_directories(folder.path() + "/scenes");  // a name that begins with the folder's
  GlbBuilder glb = test::square_glb();
  glb.bytes();
  for (const char* place : {"secret.bin", "scenes/secret.bin", "scene/inner/open.bin"})
    folder.write(place, glb.bin);
  fs::create_symlink(folder.path() + "/secret.bin", folder.path() + "/scene/link.bin");
  fs::create_directory_symlink(folder.path() + "/scenes", folder.path() + "/scene/linked");
  fs::create_symlink("inner/open.bin", folder.path() + "/scene/inside.bin");
  const std::string absolute = folder.path() + "/secret.bin";
  for (const std::string& uri :
       {std::string("../secret.bin"), std::string("..%2fsecret.bin"), std::string("%2e%2e/secret.bin"),
        std::string("inner/../../secret.bin"), std::string("../scenes/secret.bin"), std::string("link.bin"),
        std::string("linked/secret.bin"), std::string("../scene/../secret.bin"), absolute,
        "file://" + absolute, std::string("https://example.com/a.bin"), std::string("open.bin%00.png"),
        std::string(".."), std::string("."), std::string("")}) {
    glb.root["buffers"][0]["uri"] = uri;
    EXPECT_EQ(error_code(write_text(folder, "scene/scene.gltf", glb.root)), "S015") << uri;
    GlbBuilder textured = test::square_glb();
    textured.root["images"] = {{{"uri", uri}}};
    EXPECT_EQ(error_code(folder.write("scene/image.glb", textured.bytes())), "S015") << uri;
  }
  for (const std::string uri :
       {"inner/open.bin", "inside.bin", "inner/../inner/open.bin", "inner%2Fopen.bin"}) {
    glb.root["buffers"][0]["uri"] = uri;
    EXPECT_EQ(error_code(write_text(folder, "scene/scene.gltf", glb.root)), "") << uri;
  }
}

TEST(SceneFiles, DataUrisAreDecodedWhateverTheirType) {
  using gltf::decode_data_uri;
  const std::vector<std::uint8_t> abc = {'a', 'b', 'c'}, ab = {'a', 'b'};
  EXPECT_EQ(decode_data_uri("data:application/octet-stream;base64,YWJj"), abc);
  EXPECT_EQ(decode_data_uri("data:image/ktx;foo=bar;base64,YWJj"), abc);
  EXPECT_EQ(decode_data_uri("data:;base64,YWI="), ab);
  EXPECT_EQ(decode_data_uri("data:,a%62"), ab);
  EXPECT_EQ(decode_data_uri("data:;base64,Y!Jj"), std::nullopt);
  EXPECT_EQ(decode_data_uri("data:no-comma"), std::nullopt);
}

// Vertices without any byte in the file.
GlbBuilder empty_vertices(std::size_t count, bool strip) {
  GlbBuilder glb = test::square_glb();
  glb.root["accessors"].push_back({{"componentType", 5126}, {"count", count}, {"type", "VEC3"}});
  glb.primitive() = {{"attributes", {{"POSITION", 3}}}, {"mode", strip ? 5 : 4}};
  return glb;
}

TEST(SceneBudget, ASmallFileCannotAnnounceALargeMesh) {
  const TemporaryFolder folder("announced");
  EXPECT_EQ(error_code(folder.write("a.glb", empty_vertices(300'000, false).bytes())), "");
  EXPECT_EQ(error_code(folder.write("a.glb", empty_vertices(1 << 24, false).bytes())), "S012");
  EXPECT_EQ(error_code(folder.write("a.glb", empty_vertices(1 << 24, true).bytes())), "S012");
}

TEST(SceneBudget, StripsAndFlatNormalsAreChargedBeforeTheyAreExpanded) {
  const TemporaryFolder folder("charged");
  const std::string path = folder.write("a.glb", empty_vertices(900'000, true).bytes());
  SceneLoadOptions options;
  options.max_memory_bytes =
      40 << 20;  // the 900,000 positions alone would fit, three for each triangle do not
  EXPECT_EQ(error_code(path, options), "S012");
}

Bytes white_png(std::uint32_t side) {
  return testing::make_png({side, side}, Bytes(std::size_t{4} * side * side, 255));
}

GlbBuilder textured(int images, const Bytes& png) {
  GlbBuilder glb = test::square_glb();
  const int view = glb.add_view(png);
  for (int i = 0; i < images; ++i) {
    glb.root["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
    glb.root["textures"].push_back({{"source", i}});
    glb.root["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
    json primitive = glb.primitive();
    primitive["material"] = i;
    glb.root["meshes"][0]["primitives"].push_back(primitive);
  }
  return glb;
}

TEST(SceneBudget, TexturesAreChargedByTheirHeaders) {
  const TemporaryFolder folder("textures");
  Bytes png = white_png(4);
  const std::string small = folder.write("a.glb", textured(1, png).bytes());
  EXPECT_EQ(error_code(small), "");
  for (const std::size_t at : {std::size_t{18}, std::size_t{22}})
    png[at] = 0x40;  // 16388 x 16388, it says now
  EXPECT_EQ(error_code(folder.write("a.glb", textured(1, png).bytes())), "S012");
}

TEST(SceneBudget, EqualImagesAreDecodedOnce) {
  const TemporaryFolder folder("equal");
  const Scene scene = load_gltf(folder.write("a.glb", textured(3, white_png(8)).bytes()));
  ASSERT_EQ(scene.textures.size(), 3u);
  EXPECT_EQ(scene.textures[0].same_texels_as, -1);
  EXPECT_EQ(scene.textures[1].same_texels_as, 0);
  EXPECT_EQ(scene.textures[2].same_texels_as, 0);
  EXPECT_EQ(levels_of(scene, 2).front().width, 8);
  EXPECT_EQ(stats(scene).texture_bytes, 3u * (64 + 16 + 4 + 1) * 4);  // three textures for the simulated GPU
}

TEST(SceneBudget, TheLimitIsASetting) {
  const TemporaryFolder folder("limit");
  const std::string path = folder.write("a.glb", test::square_glb().bytes());
  SceneLoadOptions options;
  options.max_memory_bytes = 100;
  EXPECT_EQ(error_code(path, options), "S012");
}

}  // namespace
}  // namespace hwsim::pipeline
