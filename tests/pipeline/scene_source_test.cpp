#include "pipeline/open/scene_source.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "hwsim/base/content_hash.h"
#include "tests/pipeline/scene_glb.h"

namespace hwsim::pipeline {
namespace {
using test::Bytes;
using test::TemporaryFolder;

Bytes bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return Bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
}

std::string code_of(const std::string& spec, const std::string& folder) {
  try {
    open_scene(spec, folder);
    return "";
  } catch (const InputError& e) {
    return e.diagnostics().front().code;
  }
}

TEST(SceneSource, EveryGeneratorLoadsWithoutWarnings) {
  const TemporaryFolder folder("generators");
  ASSERT_FALSE(generators().empty());
  for (const GeneratorInfo& info : generators()) {
    const Scene scene = open_scene(info.name, folder.path());
    EXPECT_GT(stats(scene).drawn_triangles, 10000u) << info.name;
    EXPECT_EQ(scene.name, info.name);
    EXPECT_EQ(scene.cameras.at(0).name, "suggested") << info.name;
    EXPECT_EQ(scene.lights.at(0).kind, LightKind::directional) << info.name;
    for (const Diagnostic& d : scene.notes) EXPECT_EQ(d.code, "S118") << info.name << ": " << d.message;
    EXPECT_TRUE(std::any_of(info.parameters.begin(), info.parameters.end(),
                            [](const auto& p) { return p.name == "seed"; }));
    for (const GeneratorParameter& p : info.parameters) {
      EXPECT_LE(p.min, p.default_value);
      EXPECT_LE(p.default_value, p.max);
      EXPECT_FALSE(p.description.empty());
    }
  }
}

// The camera of every generator looks at the scene: the middle of some part is on the screen.
TEST(SceneSource, CamerasSeeTheirScene) {
  const TemporaryFolder folder("views");
  for (const GeneratorInfo& info : generators()) {
    const Scene scene = open_scene(info.name, folder.path());
    const glm::mat4 clip = clip_from_view(scene.cameras[0], 16.0f / 9.0f) * scene.cameras[0].view_from_world;
    std::uint64_t inside = 0, all = 0;
    for (const Instance& instance : scene.instances)
      for (const glm::vec3& p : scene.meshes[static_cast<std::size_t>(instance.mesh)].positions) {
        const glm::vec4 c = clip * instance.world_from_local * glm::vec4(p, 1);
        inside += std::abs(c.x) < c.w && std::abs(c.y) < c.w && c.z > 0 && c.z < c.w;
        ++all;
      }
    EXPECT_GT(inside * 5, all) << info.name;  // a meadow goes on beside and behind the camera
  }
}

// Golden hashes: the bytes may depend on nothing but name and parameters.
TEST(SceneSource, BytesAreTheSameOnEveryMachine) {
  const TemporaryFolder folder("golden");
  const std::vector<std::pair<std::string, std::string>> golden = {
      {"dragon", "8c69fcb91c107f2387af295c18323cf5"},     {"grass", "66a873204681495b3e5fa48a34f5bceb"},
      {"powerplant", "350daf40e79daba5a68221f3d697b20b"}, {"sponza_hall", "d9a41302e1e9c6ee24953108d39afde4"},
      {"text_page", "43f3e500d69210323dd28c0880eec4c9"},  {"wires", "510e3bdd4b56d99380fde6dc15bbb56b"},
      {"old_city", "872138ebf6ed747fa239c6c7155c885d"},   {"foliage", "e46b4bc62ca5bbacbd441934af050b99"},
      {"car_body", "8dae4f7437c9145dd635b2ab17b0a8a7"},   {"fur_ball", "c165eb54ea472fc4b98a0e104bb21e85"},
      {"bamboo", "ee56aeafa134f1ead82f866fedb35cc3"},     {"metal", "66e0ac68345a93a6314f60d097aea976"},
      {"grill", "fd026a5c792347b6e798e63bb1e05aa3"}};
  for (const auto& [name, want] : golden) {
    write_generated_scene(name, {}, folder.path() + "/a.glb");
    ContentHash hash;
    hash.add(bytes_of(folder.path() + "/a.glb"));
    EXPECT_EQ(hash.hex(), want) << name;
  }
}

TEST(SceneSource, SeedAndParametersChangeTheScene) {
  const TemporaryFolder folder("seeds");
  const Scene a = open_scene("grass:blades=1000,seed=1", folder.path());
  const Scene b = open_scene("grass:seed=2,blades=1000", folder.path());
  const Scene again = open_scene("grass:seed=1,blades=1000", folder.path());
  EXPECT_NE(a.content_hash, b.content_hash);
  EXPECT_EQ(a.content_hash, again.content_hash);
  EXPECT_EQ(stats(a).drawn_triangles, 1000u + 16 * 16 * 2);
}

TEST(SceneSource, WiresCarryTheirRadius) {
  const TemporaryFolder folder("wires");
  const Scene scene = open_scene("wires:poles=3,wires=2,segments=4,sides=5,radius_m=0.02", folder.path());
  const auto mesh =
      std::find_if(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& m) { return !m.radius.empty(); });
  ASSERT_NE(mesh, scene.meshes.end());
  EXPECT_EQ(mesh->positions.size(), 2u * 2 * 5 * 5);
  ASSERT_EQ(mesh->tangents.size(), mesh->positions.size());
  for (std::size_t i = 0; i < mesh->positions.size(); ++i) {
    EXPECT_EQ(mesh->radius[i], 0.02f);
    EXPECT_NEAR(glm::dot(mesh->normals[i], glm::vec3(mesh->tangents[i])), 0.0f, 1e-5f);
  }
}

TEST(SceneSource, WrongSpecificationsAreErrorsWithTheNearestName) {
  const TemporaryFolder folder("specs");
  EXPECT_EQ(code_of("gras", folder.path()), "S201");
  EXPECT_EQ(code_of("grass:blade=3", folder.path()), "S202");
  EXPECT_EQ(code_of("grass:blades=0", folder.path()), "S203");
  EXPECT_EQ(code_of("grass:blades=nan", folder.path()), "S203");
  EXPECT_EQ(code_of("grass:blades", folder.path()), "S204");
  EXPECT_EQ(code_of("grass:blades=3x", folder.path()), "S204");
  EXPECT_EQ(code_of("grass:blades=3,blades=4", folder.path()), "S204");
  EXPECT_EQ(code_of("none.glb", folder.path()), "S001");
  try {
    open_scene("gras", folder.path());
  } catch (const InputError& e) {
    EXPECT_EQ(e.diagnostics().front().hint, "did you mean `grass`?");
  }
  EXPECT_THROW(write_generated_scene("grass", {{"blades", -1}}, folder.path() + "/x.glb"), InputError);
}

TEST(SceneSource, ADamagedCacheFileIsWrittenAnew) {
  const TemporaryFolder folder("cache");
  const std::string hash = open_scene("grass:blades=50", folder.path()).content_hash;
  ASSERT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  const std::string file = std::filesystem::directory_iterator(folder.path())->path().string();
  std::filesystem::resize_file(file, 100);
  EXPECT_EQ(open_scene("grass:blades=50", folder.path()).content_hash, hash);
}

std::vector<std::string> notes_of(const std::string& spec, const std::string& folder, std::string& hash) {
  std::vector<std::string> codes;
  hash =
      open_scene(spec, folder, {}, [&](const Diagnostic& note) { codes.push_back(note.code); }).content_hash;
  return codes;
}

using Codes = std::vector<std::string>;

// One bit of a position gives another picture, and the file stays a scene.
TEST(SceneSource, AFlippedBitInACacheFileIsNotedAndMadeAnew) {
  const TemporaryFolder folder("flipped");
  std::string made, now;
  EXPECT_EQ(notes_of("grass:blades=50", folder.path(), made), Codes{});
  const std::string file = std::filesystem::directory_iterator(folder.path())->path().string();
  const Bytes good = bytes_of(file);
  for (const std::size_t at : {std::size_t{0}, std::size_t{20}, good.size() / 2, good.size() - 1}) {
    Bytes bad = good;
    bad[at] ^= 4;
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(bad.data()), std::ssize(bad));
    EXPECT_EQ(notes_of("grass:blades=50", folder.path(), now), Codes{"K001"}) << at;
    EXPECT_EQ(now, made);
    EXPECT_EQ(notes_of("grass:blades=50", folder.path(), now), Codes{}) << "it was not made anew";
  }
}

TEST(SceneSource, ACacheThatCannotBeWrittenOrTrustedIsNotUsed) {
  const TemporaryFolder folder("unusable");
  std::string made, now;
  EXPECT_EQ(notes_of("grass:blades=50", "", made), Codes{});
  EXPECT_EQ(notes_of("grass:blades=50", folder.write("file", {1}), now), Codes{"K002"});
  EXPECT_EQ(now, made);
  if (::geteuid() != 0) return;  // only root may give a folder away
  const std::string foreign = folder.path() + "/foreign";
  std::filesystem::create_directory(foreign);
  ASSERT_EQ(::chown(foreign.c_str(), 65534, 65534), 0);
  EXPECT_EQ(notes_of("grass:blades=50", foreign, now), Codes{"K002"});
  EXPECT_TRUE(std::filesystem::is_empty(foreign));
}

TEST(SceneSource, TheCacheIsClosedToOthers) {
  const TemporaryFolder folder("private");
  const std::string cache = folder.path() + "/cache";
  std::filesystem::create_directory(cache);
  std::filesystem::permissions(cache, std::filesystem::perms::all);
  open_scene("grass:blades=50", cache);
  EXPECT_EQ(std::filesystem::status(cache).permissions(), std::filesystem::perms::owner_all);
}

}  // namespace
}  // namespace hwsim::pipeline
