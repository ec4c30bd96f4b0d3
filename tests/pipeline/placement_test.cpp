// Scenes far from the origin, tiny and huge ones: drawn as if they stood at the origin in meters.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pipeline/gltf/gltf_loader.h"
#include "pipeline/gltf/placement.h"
#include "tests/pipeline/scene_glb.h"

namespace hwsim::pipeline {
namespace {
using nlohmann::json;
using test::GlbBuilder;
using test::TemporaryFolder;

/// A square, a point light and a camera below one root node, which moves and scales them all.
GlbBuilder scene_below(const json& root_node, double unit = 1.0) {
  GlbBuilder glb = test::square_glb();
  glb.root["nodes"] = {
      {{"mesh", 0}, {"name", "square"}, {"scale", {4, 4, 4}}},
      {{"name", "eye"}, {"camera", 0}, {"translation", {2, 2, 12}}},
      {{"translation", {1, 3, 2}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
      root_node};
  glb.root["nodes"][3]["children"] = {0, 1, 2};
  glb.root["scenes"][0]["nodes"] = {3};
  glb.root["cameras"] = {{{"type", "perspective"},
                          {"perspective", {{"yfov", 0.8}, {"znear", 0.1 * unit}, {"zfar", 50 * unit}}}}};
  glb.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 8.0 * unit * unit}, {"range", 30.0 * unit}}};
  return glb;
}

class ScenePlacement : public testing::Test {
 protected:
  TemporaryFolder folder{std::string("placement_") +
                         testing::UnitTest::GetInstance()->current_test_info()->name()};
  Scene load(GlbBuilder glb) { return load_gltf(folder.write("scene.glb", glb.bytes())); }

  void expect_same(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.instances.size(), b.instances.size());
    EXPECT_EQ(a.instances[0].world_from_local, b.instances[0].world_from_local);
    EXPECT_EQ(a.meshes[0].positions, b.meshes[0].positions);
    EXPECT_EQ(a.cameras[0].view_from_world, b.cameras[0].view_from_world);
    EXPECT_EQ(a.cameras[0].near_m, b.cameras[0].near_m);
    EXPECT_EQ(a.cameras[0].far_m, b.cameras[0].far_m);
    EXPECT_EQ(a.lights[0].position, b.lights[0].position);
    EXPECT_EQ(a.lights[0].range_m, b.lights[0].range_m);
    EXPECT_FLOAT_EQ(a.lights[0].color.x, b.lights[0].color.x);
  }
};

TEST_F(ScenePlacement, ASceneAtMapCoordinatesHasTheVeryNumbersOfOneAtTheOrigin) {
  const Scene here = load(scene_below(json::object()));
  EXPECT_EQ(here.origin_m, glm::dvec3(0.0));
  EXPECT_EQ(here.meters_per_unit, 1.0);
  for (const double far : {1e3, 1e5, 5e6, 1e7}) {
    const Scene there = load(scene_below({{"translation", {far, -2 * far, 3 * far}}}));
    expect_same(there, here);
    EXPECT_EQ(there.origin_m, glm::dvec3(far, -2 * far, 3 * far));
  }
}

TEST_F(ScenePlacement, AnOddDistanceLeavesAnErrorOfRoundingOnly) {
  const Scene here = load(scene_below(json::object()));
  const Scene there = load(scene_below({{"translation", {4321098.7, 12.3, -9876543.2}}}));
  for (int i = 0; i < 3; ++i) EXPECT_LT(std::abs(there.instances[0].world_from_local[3][i]), 60.0f);
  const glm::mat4 view_here = here.cameras[0].view_from_world * here.instances[0].world_from_local;
  const glm::mat4 view_there = there.cameras[0].view_from_world * there.instances[0].world_from_local;
  for (int i = 0; i < 16; ++i) EXPECT_NEAR(view_here[i / 4][i % 4], view_there[i / 4][i % 4], 2e-5f);
}

TEST_F(ScenePlacement, CoordinatesInsideOfTheVerticesAreMovedToo) {
  GlbBuilder glb = test::square_glb();
  std::vector<float> far = test::square_positions();
  for (std::size_t i = 0; i < far.size(); i += 3) far[i] += 1e5f;
  glb.add_attribute("POSITION", far, "VEC3", 3);
  glb.root["nodes"][0]["rotation"] = {0, 0, 0.6, 0.8};
  const Scene scene = load(glb);
  EXPECT_EQ(scene.meshes[0].positions, load(test::square_glb()).meshes[0].positions);
  const SceneStats s = stats(scene);
  for (int i = 0; i < 3; ++i)
    EXPECT_LT(std::max(std::abs(s.bounds_min[i]), std::abs(s.bounds_max[i])), 20.0f);
}

TEST_F(ScenePlacement, TinyAndHugeScenesHaveTheNumbersOfOneInMeters) {
  const Scene here = load(scene_below(json::object()));
  for (const double unit : {1e-18, 1e-12, 1e-8, 1e-3, 1e6, 1e9, 1e13}) {
    const Scene there = load(scene_below({{"scale", {unit, unit, unit}}}, unit));
    for (int i = 0; i < 16; ++i) {
      EXPECT_NEAR(there.instances[0].world_from_local[i / 4][i % 4],
                  here.instances[0].world_from_local[i / 4][i % 4], 1e-5f)
          << unit;
      EXPECT_NEAR(there.cameras[0].view_from_world[i / 4][i % 4],
                  here.cameras[0].view_from_world[i / 4][i % 4], 1e-5f)
          << unit;
    }
    EXPECT_FLOAT_EQ(there.cameras[0].near_m, 0.1f) << unit;
    EXPECT_FLOAT_EQ(there.lights[0].color.x, 8.0f) << unit;
    EXPECT_FLOAT_EQ(there.lights[0].range_m, 30.0f) << unit;
    EXPECT_NEAR(there.meters_per_unit / unit, 1.0, 1e-12);
  }
}

// Within a float's range too: what a file's nodes share of their scales is its unit, and no size.
TEST_F(ScenePlacement, AnyUnitGivesTheVeryNumbersOfAnother) {
  const Scene here = load(scene_below(json::object()));
  for (const double unit : {1e-3, 0.01, 0.0254, 0.3048, 3.0, 100.0, 0x1p13, 1e4})
    for (const double far : {0.0, 5e6}) {
      if (far > 0.0 && unit > 1e3) continue;  // no round number beside a scene as large
      const Scene there =
          load(scene_below({{"scale", {unit, unit, unit}}, {"translation", {far, 0, -far}}}, unit));
      EXPECT_EQ(there.instances[0].world_from_local, here.instances[0].world_from_local) << unit;
      EXPECT_EQ(there.cameras[0].view_from_world, here.cameras[0].view_from_world) << unit;
      EXPECT_FLOAT_EQ(there.cameras[0].near_m, here.cameras[0].near_m) << unit;
      EXPECT_DOUBLE_EQ(there.meters_per_unit, unit);
    }
}

TEST_F(ScenePlacement, AScaleOfEachNodeIsAUnitWhereAllHaveIt) {
  const auto two_nodes = [&](double first, double second) {
    GlbBuilder glb = test::square_glb();
    glb.root["nodes"] = {{{"mesh", 0}, {"scale", {first, first, first}}},
                         {{"mesh", 0}, {"scale", {second, second, second}}, {"translation", {first, 0, 0}}}};
    glb.root["scenes"][0]["nodes"] = {0, 1};
    return load(glb);
  };
  EXPECT_DOUBLE_EQ(two_nodes(0.01, 0.01).meters_per_unit, 0.01);
  EXPECT_EQ(two_nodes(0.01, 0.01).instances[0].world_from_local, glm::mat4(1.0f));
  EXPECT_EQ(two_nodes(2, 2).meters_per_unit, 1.0);
  EXPECT_EQ(two_nodes(100, 50).meters_per_unit, 1.0);
}

// Techniques' options in meters keep their meaning where the scene's meters have one.
TEST_F(ScenePlacement, MetersOfOptionsAreTheScenes) {
  const auto option_of = [&](double unit) {
    return load(scene_below({{"scale", {unit, unit, unit}}}, unit)).units_per_option_m;
  };
  EXPECT_EQ(option_of(1.0), 1.0);
  EXPECT_DOUBLE_EQ(option_of(0.1), 10.0);
  EXPECT_DOUBLE_EQ(option_of(100.0), 0.01);
  EXPECT_EQ(option_of(1e4), 1.0);
  EXPECT_EQ(option_of(1e-3), 1.0);
}

TEST_F(ScenePlacement, ACameraOfASceneOfAnySizeIsKept) {
  for (const double unit : {1e-30, 1e-12, 1e13}) {
    const Scene there = load(scene_below({{"scale", {unit, unit, unit}}}, unit));
    ASSERT_EQ(there.cameras.size(), 1u) << unit;
    EXPECT_EQ(there.cameras[0].name, "eye") << unit;
    EXPECT_NEAR(there.cameras[0].view_from_world[3].z, -12.0f, 1e-5f) << unit;
  }
}

TEST_F(ScenePlacement, ACameraBesideWhoseLengthsTheSceneVanishesIsLeftOut) {
  GlbBuilder glb = scene_below(json::object());
  glb.root["cameras"][0]["perspective"]["zfar"] = 1e25;
  EXPECT_EQ(load(glb).cameras.at(0).name, "eye");  // whose far plane is as good as another
  EXPECT_FLOAT_EQ(load(glb).cameras.at(0).far_m, 1e18f);
  glb.root["cameras"][0]["perspective"]["znear"] = 1e20;
  const Scene scene = load(glb);
  EXPECT_EQ(scene.cameras.at(0).name, "default");
  EXPECT_EQ(std::count_if(scene.notes.begin(), scene.notes.end(),
                          [](const Diagnostic& d) { return d.code == "S115"; }),
            1);
}

TEST_F(ScenePlacement, PartsThatAFloatWouldRoundAwayAreSaid) {
  const auto warned = [&](double distance) {
    GlbBuilder glb = test::square_glb();
    glb.root["nodes"].push_back({{"mesh", 0}, {"translation", {distance, 0, 0}}});
    glb.root["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = load(glb);
    return std::any_of(scene.notes.begin(), scene.notes.end(), [](const Diagnostic& d) {
      return d.code == "S120" && d.severity == Severity::warning;
    });
  };
  EXPECT_FALSE(warned(1e5));
  EXPECT_TRUE(warned(5e6));
}

TEST_F(ScenePlacement, HugeVerticesUnderATinyScaleMeetInTheMiddle) {
  GlbBuilder glb = test::square_glb();
  std::vector<float> huge = test::square_positions();
  for (float& x : huge) x *= 1e10f;
  glb.add_attribute("POSITION", huge, "VEC3", 3);
  glb.root["nodes"][0]["scale"] = {1e-10, 1e-10, 1e-10};
  const Scene scene = load(glb);
  EXPECT_EQ(scene.meters_per_unit, 1.0);
  const glm::mat4& m = scene.instances[0].world_from_local;
  EXPECT_FLOAT_EQ(m[0][0], 1.0f);
  EXPECT_FLOAT_EQ(scene.meshes[0].positions[1].x, 1.0f);
}

// What counts is what is drawn, not the numbers on the way: 1e-30 m under a scale of 1e30 is a meter.
TEST_F(ScenePlacement, TinyVerticesUnderAHugeScaleAreAsGoodAsOthers) {
  const auto box = [&](double vertices, const std::vector<double>& scales) {
    GlbBuilder glb;
    std::vector<float> corners = test::square_positions();
    for (float& c : corners) c = static_cast<float>(c * vertices);
    glb.add_attribute("POSITION", corners, "VEC3", 3);
    glb.primitive()["mode"] = 5;
    for (std::size_t i = 0; i < scales.size(); ++i) {
      glb.root["nodes"][i]["scale"] = {scales[i], scales[i], scales[i]};
      if (i > 0) glb.root["nodes"][i]["children"] = {i - 1};
    }
    glb.root["scenes"][0]["nodes"] = {scales.size() - 1};
    return stats(load(glb)).bounds_max;
  };
  const glm::vec3 plain = box(1.0, {1.0});
  for (const double unit : {1e-20, 1e-30, 1e-35})
    EXPECT_LT(glm::length(box(unit, {1.0 / unit}) - plain), 1e-6f) << unit;
  EXPECT_LT(glm::length(box(1.0, {1e-20, 1e20}) - plain), 1e-6f);
  EXPECT_LT(glm::length(box(1.0, {1e40, 1e-60, 1e20}) - plain), 1e-6f);
}

TEST_F(ScenePlacement, ACameraFarFromATinySceneStaysInRange) {
  GlbBuilder glb = scene_below(json::object());
  glb.root["nodes"][0]["scale"] = {1e-9, 1e-9, 1e-9};
  glb.root["nodes"][0]["translation"] = {1e10, 1e10, -1e10};
  const Scene scene = load(glb);
  const glm::vec4 eye = glm::inverse(scene.cameras[0].view_from_world)[3];
  EXPECT_TRUE(std::isfinite(eye.x));
  EXPECT_LT(glm::length(glm::vec3(eye)), 1e13f);
  glb = scene_below(json::object());
  glb.root["nodes"][0]["scale"] = {1e-30, 1e-30, 1e-30};
  EXPECT_EQ(load(glb).cameras.at(0).name, "eye");
}

TEST_F(ScenePlacement, ATransformationOutOfRangeIsRefusedWithItsNode) {
  GlbBuilder glb = test::square_glb();
  glb.root["nodes"][0]["translation"] = {1e19, 0, 0};
  try {
    load(glb);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("nodes[0]"), std::string::npos) << e.what();
  }
}

TEST_F(ScenePlacement, TheDefaultCameraFramesASceneOfAnySize) {
  for (const double unit : {1e-12, 1.0, 1e13}) {
    GlbBuilder glb = test::square_glb();
    glb.root["nodes"][0]["scale"] = {unit, unit, unit};
    const Scene scene = load(glb);
    const glm::mat4 clip = clip_from_view(scene.cameras[0], 1.0f) * scene.cameras[0].view_from_world *
                           scene.instances[0].world_from_local;
    const glm::vec4 a = clip * glm::vec4(0, 0, 0, 1), b = clip * glm::vec4(1, 1, 0, 1);
    EXPECT_GT(glm::length(glm::vec2(a) / a.w - glm::vec2(b) / b.w), 0.5f) << unit;
    EXPECT_LT(std::abs(a.x), a.w);
  }
}

}  // namespace
}  // namespace hwsim::pipeline
