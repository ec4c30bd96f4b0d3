// Every modifier with every base and every filter: a valid graph that runs, counts that conserve, an image
// that holds what the modifier draws.
#include <gtest/gtest.h>

#include <cmath>

#include "algos/frame_run.h"
#include "algos/sss_scenes.h"

namespace hwsim::test {
namespace {
using namespace pipeline;

constexpr int kWidth = 64, kHeight = 48;
constexpr float kWireY = 0.72f;

/// A slanted wire four fifths of a pixel wide that glows red, in front of everything.
Mesh wire_mesh(int material) {
  constexpr int kSides = 8, kAlong = 4;
  const float radius = 0.024f;
  const glm::vec3 axis = glm::normalize(glm::vec3(1.0f, 0.05f, 0.0f)),
                  up = glm::cross(glm::vec3(0, 0, 1), axis);
  Mesh mesh;
  for (int i = 0; i <= kAlong; ++i)
    for (int j = 0; j < kSides; ++j) {
      const float a = 6.2831853f * static_cast<float>(j) / kSides;
      const glm::vec3 n = std::sin(a) * up + std::cos(a) * glm::vec3(0, 0, 1);
      const float along = 2.0f * (2.0f * static_cast<float>(i) / kAlong - 1.0f);
      mesh.positions.push_back(glm::vec3(0.0f, kWireY, 0.5f) + along * axis + radius * n);
      mesh.normals.push_back(n);
      mesh.tangents.push_back(glm::vec4(axis, 1.0f));
      mesh.radius.push_back(radius);
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * kSides + j % kSides); };
  for (int i = 0; i < kAlong; ++i)
    for (int j = 0; j < kSides; ++j)
      mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j),
                                               at(i + 1, j + 1), at(i, j + 1)});
  mesh.parts = {{0, static_cast<std::uint32_t>(mesh.indices.size()), material}};
  mesh.vertex_bytes = 40;
  mesh.bounds_min = glm::vec3(-2.1f, 0.5f, 0.4f);
  mesh.bounds_max = glm::vec3(2.1f, 0.9f, 0.6f);
  return mesh;
}

/// A pane in front of half of the picture: blended, or tested against its alpha.
Mesh pane(int material, float left, float z) {
  Mesh mesh;
  mesh.positions = {{left, -0.4f, z}, {left + 0.5f, -0.4f, z}, {left + 0.5f, 0.1f, z}, {left, 0.1f, z}};
  mesh.normals.assign(4, glm::vec3(0, 0, 1));
  mesh.indices = {0, 1, 2, 0, 2, 3};
  mesh.parts = {{0, 6, material}};
  mesh.vertex_bytes = 24;
  mesh.bounds_min = glm::vec3(left, -0.4f, z);
  mesh.bounds_max = glm::vec3(left + 0.5f, 0.1f, z);
  return mesh;
}

/// Rods whose highlights selective supersampling samples, a blended pane, an alpha-tested one, and the wire.
std::shared_ptr<const Scene> scene_of_all(bool wire) {
  Scene scene = *sss::rods();
  scene.ambient = glm::vec3(0.1f);
  scene.materials[0].base_color = {0.4f, 0.5f, 0.6f, 1.0f};  // nothing but the wire is red
  scene.materials.resize(4, scene.materials[0]);
  scene.materials[1].alpha_mode = AlphaMode::blend;
  scene.materials[1].base_color = {0.2f, 0.8f, 0.3f, 0.5f};
  scene.materials[2].alpha_mode = AlphaMode::mask;
  scene.materials[2].base_color = {0.3f, 0.3f, 0.9f, 0.9f};
  scene.materials[3].base_color = {0.0f, 0.0f, 0.0f, 1.0f};
  scene.materials[3].emissive = {1.0f, 0.0f, 0.0f};
  const auto add = [&](Mesh mesh) {
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, glm::mat4(1.0f), "part"});
  };
  add(pane(1, -0.7f, 0.3f));
  add(pane(2, 0.2f, 0.2f));
  if (wire) add(wire_mesh(3));
  return std::make_shared<const Scene>(std::move(scene));
}

Emulation run_checked(const std::shared_ptr<const Scene>& scene, const std::string& technique,
                      const GpuFeatures& features) {
  algos::FrameRequest request;
  request.scene = scene;
  request.width_px = kWidth;
  request.height_px = kHeight;
  request.shadow_map_px = 64;
  request.features = features;
  const Emulation e = emulate(algos::build_frame(algos::parse_technique(technique), request), features,
                              FunctionalConfig{}, {});
  for (const PassWork& pass : e.trace.passes)
    for (const CounterViolation& v : algos::broken_laws(total(pass)))
      ADD_FAILURE() << technique << ", pass " << pass.name << ": " << v.law;
  for (const glm::vec4& p : e.color.pixels)
    if (!std::isfinite(p.x + p.y + p.z)) {
      ADD_FAILURE() << technique << ": a color is no number";
      break;
    }
  return e;
}

/// Columns in the middle of the picture in which some pixel of the wire's rows is red.
int red_columns(const Image& image) {
  int columns = 0;
  for (int x = kWidth / 4; x < 3 * kWidth / 4; ++x) {
    bool red = false;
    for (int y = 0; y < kHeight / 2; ++y) red = red || image.at(x, y).x > image.at(x, y).y + 0.1f;
    columns += red ? 1 : 0;
  }
  return columns;
}

class Products : public ::testing::TestWithParam<std::string> {};

TEST_P(Products, EveryModifierAndFilterGoesWithTheBase) {
  const std::shared_ptr<const Scene> scene = scene_of_all(true);
  std::vector<std::string> modifiers = {""}, filters = {""};
  for (const algos::TechniqueInfo& t : algos::techniques()) {
    if (t.kind() == algos::TechniqueKind::modifier) modifiers.push_back(std::string(t.id) + "+");
    if (t.kind() == algos::TechniqueKind::filter) filters.push_back("+" + std::string(t.id));
  }
  ASSERT_GT(modifiers.size(), 1u);
  ASSERT_GT(filters.size(), 1u);
  for (const std::string& modifier : modifiers)
    for (const std::string& filter : filters)
      for (const int native : {8, 32}) {
        if (native == 32 && !filter.empty()) continue;  // filters see one sample a pixel in any case
        const std::string technique = modifier + GetParam() + filter;
        SCOPED_TRACE(technique + ", native up to " + std::to_string(native));
        const Emulation e = run_checked(scene, technique, every_feature(native));
        if (modifier == "wire_aa+") {
          EXPECT_EQ(red_columns(e.color), kWidth / 2) << "the wire has gaps";
        }
      }
}

// What the test above looks for is there because the modifier drew it.
TEST_P(Products, TheWireIsTheModifiersWork) {
  const Emulation none = run_checked(scene_of_all(false), "wire_aa+" + GetParam(), every_feature(8));
  EXPECT_EQ(red_columns(none.color), 0);
  for (const PassWork& pass : none.trace.passes) EXPECT_NE(pass.name, "wires");
}

std::vector<std::string> bases() {
  std::vector<std::string> all;
  for (const algos::TechniqueInfo& t : algos::techniques())
    if (t.kind() == algos::TechniqueKind::base) all.emplace_back(t.id);
  for (const char* variant : {"ssaa4x:variant=accumulate", "ssaa4x:variant=sample_rate", "deferred:samples=1",
                              "deferred_simple_complex:lighting=compute", "agaa:msaa=32",
                              "agaa:accumulate=atomics", "sbaa_merge:n=4", "sss_cs:rest=frame"})
    all.emplace_back(variant);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Bases, Products, ::testing::ValuesIn(bases()), [](const auto& parameter) {
  std::string name = parameter.param;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
});

// Each of the parts acts on this scene, or the products above would show nothing.
TEST(ProductScene, EveryPartActsOnTheScene) {
  const std::shared_ptr<const Scene> scene = scene_of_all(true);
  const Emulation plain = run_checked(scene, "none", every_feature(8));
  for (const algos::TechniqueInfo& t : algos::techniques()) {
    if (t.id == "none") continue;
    // At one sample it shows what `none` does.
    const std::string text = t.id == "forward_plus" ? "forward_plus:samples=4" : std::string(t.id);
    EXPECT_NE(difference(plain.color, run_checked(scene, text, every_feature(8)).color, "image"), "") << text;
  }
}

}  // namespace
}  // namespace hwsim::test
