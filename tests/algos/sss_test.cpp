// Selective shader supersampling (techniques 5.8): weights, coverage, visibility, order, memory, and beads on
// a thin highlight.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "algos/frame_run.h"
#include "algos/shaders/sss.h"
#include "algos/sss_classify.h"
#include "hwsim/base/diagnostics.h"
#include "support/frames.h"

// One vector target is enough here: without foreach_target.
#include "algos/shaders/sss_pixel-inl.h"
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"
#include "pipeline/shade/scalar_lane-inl.h"

namespace hwsim::test {
namespace {
using namespace pipeline;

constexpr int kWidth = 96, kHeight = 64;
const char* const kVariants[] = {"sss_gs", "sss_cs", "sss_ppll"};

/// A cylinder along x with smooth normals; the eye looks at it along -z.
void add_cylinder(Mesh& mesh, float y, float radius, int around, int along, float tilt = 0.0f) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int i = 0; i <= along; ++i)
    for (int j = 0; j <= around; ++j) {
      const float a = 6.2831853f * static_cast<float>(j) / static_cast<float>(around);
      const float x = -3.0f + 6.0f * static_cast<float>(i) / static_cast<float>(along);
      mesh.positions.push_back({x, y + tilt * x + radius * std::sin(a), radius * std::cos(a)});
      mesh.normals.push_back({0.0f, std::sin(a), std::cos(a)});
    }
  const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(i * (around + 1) + j); };
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < around; ++j)
      mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j),
                                               at(i + 1, j + 1), at(i, j + 1)});
}

Scene empty_scene() {
  Scene scene;
  scene.name = "strip";
  scene.materials.emplace_back();
  scene.materials[0].base_color = {0.6f, 0.5f, 0.4f, 1.0f};
  scene.materials[0].metallic = 1.0f;
  scene.materials[0].roughness = 0.35f;
  scene.samplers.emplace_back();
  Light sun;
  sun.direction = glm::normalize(glm::vec3(0.0f, -0.7f, -0.7f));
  scene.lights = {sun};
  Camera camera;
  camera.view_from_world = glm::lookAt(glm::vec3(0, 0, 6), glm::vec3(0.0f), glm::vec3(0, 1, 0));
  camera.fov_y_rad = 0.5f;
  camera.near_m = 1.0f;
  camera.far_m = 20.0f;
  scene.cameras = {camera};
  scene.background = glm::vec3(0.0f);
  return scene;
}

std::shared_ptr<const Scene> finish(Scene scene, Mesh mesh) {
  mesh.parts = {{0, static_cast<std::uint32_t>(mesh.indices.size()), 0}};
  mesh.vertex_bytes = 24;
  mesh.bounds_min = glm::vec3(1e9f);
  mesh.bounds_max = glm::vec3(-1e9f);
  for (const glm::vec3& p : mesh.positions) {
    mesh.bounds_min = glm::min(mesh.bounds_min, p);
    mesh.bounds_max = glm::max(mesh.bounds_max, p);
  }
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, glm::mat4(1.0f), "mesh"});
  return std::make_shared<const Scene>(std::move(scene));
}

/// A few thin rods, slightly tilted.
std::shared_ptr<const Scene> rods() {
  Mesh mesh;
  for (int i = 0; i < 5; ++i)
    add_cylinder(mesh, -1.0f + 0.5f * static_cast<float>(i), 0.02f + 0.02f * static_cast<float>(i), 10, 60,
                 0.02f);
  return finish(empty_scene(), std::move(mesh));
}

FrameGraph graph_of(const std::shared_ptr<const Scene>& scene, const std::string& technique,
                    int width = kWidth, int height = kHeight) {
  algos::FrameRequest request;
  request.scene = scene;
  request.width_px = width;
  request.height_px = height;
  request.shadows = false;
  request.features.conservative_raster = true;
  return algos::build_frame(algos::parse_technique(technique), request);
}
Emulation run(const std::shared_ptr<const Scene>& scene, const std::string& technique, int width = kWidth,
              int height = kHeight) {
  GpuFeatures features;
  features.conservative_raster = true;
  return emulate(graph_of(scene, technique, width, height), features, FunctionalConfig{}, {});
}
const TechniqueCounters counters(const Emulation& e) { return total(e.trace).technique; }

float largest_difference(const Image& a, const Image& b) {
  float most = 0.0f;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(a.pixels[i][c] - b.pixels[i][c]));
  return most;
}

TEST(Sss, ClassificationFollowsTheAngleBetweenNormals) {
  Mesh mesh;
  add_cylinder(mesh, 0.0f, 0.3f, 72, 2);  // neighboring normals are 5 degrees apart
  const auto scene = finish(empty_scene(), std::move(mesh));
  const auto count = [&](double deg) {
    return algos::find_critical(*scene, {{0, 0}}, deg * 3.14159265358979 / 180.0)[0].size() / 3;
  };
  EXPECT_EQ(count(4.99), 72u * 2 * 2);
  EXPECT_EQ(count(5.01), 0u);
}

TEST(Sss, WithoutCriticalTrianglesTheImageIsThatOfMultisampling) {
  const auto scene = rods();
  const Emulation msaa = run(scene, "msaa8x");
  for (const std::string variant : kVariants) {
    const Emulation none = run(scene, variant + ":theta_c=90");
    EXPECT_EQ(difference(msaa.color, none.color, "image"), "") << variant;
    EXPECT_EQ(none.trace.passes.size(), msaa.trace.passes.size());
    // All of them uncritical in this view: the further passes run and change nothing.
    const Emulation small = run(scene, variant + ":tri_px=0");
    EXPECT_EQ(difference(msaa.color, small.color, "image"), "") << variant;
    EXPECT_GT(counters(small).sss_tested_primitives, 0u);
    EXPECT_EQ(counters(small).sss_processed_primitives, 0u);
    EXPECT_EQ(counters(small).sss_shaded_samples, 0u);
  }
}

// Half the pixel's places lie on edges of a fan through them; each must be in exactly one triangle.
TEST(Sss, PlacesOnSharedEdgesBelongToOneTriangle) {
  using F = pipeline::HWY_NAMESPACE::ScalarF;
  std::mt19937 random(7);
  const auto uniform = [&](int low, int high) {
    return static_cast<float>(static_cast<int>(random() % static_cast<unsigned>(high - low + 1)) + low);
  };
  for (int round = 0; round < 2000; ++round) {
    const int m = 2 << (round % 3), step = 256 / m;
    // A square around the pixel and a hub that often hits a place or a row of them.
    const float hub_x = round % 2 == 0 ? uniform(0, 2 * m) * static_cast<float>(step) / 2 : uniform(0, 256);
    const float hub_y = uniform(0, 2 * m) * static_cast<float>(step) / 2;
    const float rim[8][2] = {{-300, -300}, {hub_x, -300}, {600, -300}, {600, hub_y},
                             {600, 600},   {hub_x, 600},  {-300, 600}, {-300, hub_y}};
    std::vector<int> found(static_cast<std::size_t>(m * m), 0);
    for (int t = 0; t < 8; ++t) {
      const auto *p = rim[t], *q = rim[(t + 1) % 8];
      algos::HWY_NAMESPACE::PixelTriangle<F> triangle;
      const bool turned = (round & 4) != 0;
      const float x[3] = {hub_x, turned ? q[0] : p[0], turned ? p[0] : q[0]};
      const float y[3] = {hub_y, turned ? q[1] : p[1], turned ? p[1] : q[1]};
      for (int v = 0; v < 3; ++v) {
        triangle.x[v] = x[(v + t) % 3];
        triangle.y[v] = y[(v + t) % 3];
      }
      triangle.area2 = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
      if (triangle.area2.v == 0.0f) continue;
      for (int i = 0; i < m * m; ++i) {
        const F px((static_cast<float>(i % m) + 0.5f) * static_cast<float>(step));
        const F py((static_cast<float>(i / m) + 0.5f) * static_cast<float>(step));
        found[static_cast<std::size_t>(i)] += triangle.covers(px, py).v ? 1 : 0;
      }
    }
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_EQ(found[i], 1) << round << " place " << i;
  }
}

/// Adds the weight of each point up.
struct WeightShader {
  struct Uniforms {};
  template <class S>
  static void run(S& s, const Uniforms&) {
    using F = typename S::F;
    const F weight = s.flat_attr(6);
    s.output(0, {weight, F(0.0f), F(0.0f), F(1.0f)});
  }
};

TEST(Sss, WeightsOfATrianglesPointsAddUpToItsArea) {
  namespace lanes = pipeline::HWY_NAMESPACE;
  static FragmentProgram program = lanes::describe_fragment_shader<WeightShader>(
      "weight", [](FragmentBatch& b, const void* u) { lanes::run_fragment_shader<WeightShader>(b, u); });
  program.varying_scalars = 9;
  // 8 by 4.5 pixels, inside the view, w = 1, counterclockwise
  const auto scene = share(
      clip_space_scene({{0.0f, 0.0f, 0.5f}, {0.125f, 0.0f, 0.5f}, {0.0f, 0.0703125f, 0.5f}}, {0, 1, 2}));
  for (const float rho : {1.0f, 3.0f, 16.0f}) {
    auto u = std::make_shared<algos::SssUniforms>();
    u->width_px = u->height_px = 128;
    u->mode = algos::SssMode::either;
    u->triangle_px = u->highlight_px = 1e6f;
    u->early_exit = false;
    u->samples_per_px = rho;
    u->samples_max = 72.0f;
    SampleFrame frame(scene, 128, 128, 1);
    DrawBatch batch = frame.all_draws(mesh_surface_program(), &program);
    batch.geometry = &algos::sss_points_program(algos::SssVertex::plain, 72);
    batch.geometry_uniforms = u;
    batch.fragment_uniforms = std::make_shared<int>(0);
    batch.state.blend = {{true, BlendFactor::one, BlendFactor::one, BlendFactor::one, BlendFactor::one, 0xf}};
    frame.draw("points", {batch});
    const Emulation e = frame.run();
    double sum = 0.0, points = 0.0;
    for (const glm::vec4& p : e.color.pixels) sum += p.x;
    points = static_cast<double>(counters(e).sss_point_samples);
    const double area = 0.5 * 8 * 4.5, wanted = std::ceil(rho * area);
    EXPECT_EQ(points, std::min(wanted, 72.0)) << rho;
    if (wanted <= 72.0) {
      EXPECT_NEAR(sum, area, area * 1e-5) << rho;
    }
  }
}

TEST(Sss, BothPointVariantsGiveTheSameImage) {
  const auto scene = rods();
  const std::string parameters = ":mode=or,hl_px=2,early_exit=off,k_max=48";
  const Emulation gs = run(scene, "sss_gs" + parameters), cs = run(scene, "sss_cs" + parameters);
  EXPECT_GT(counters(gs).sss_point_samples, 1000u);
  EXPECT_EQ(counters(gs).sss_point_samples, counters(cs).sss_point_samples);
  EXPECT_EQ(counters(gs).sss_processed_primitives, counters(cs).sss_processed_primitives);
  // Half floats: the sums have 11 bits, and so the mean of a pixel half a step of 8 bits, twice.
  double sum = 0.0;
  for (std::size_t i = 0; i < gs.color.pixels.size(); ++i)
    sum += std::abs(gs.color.pixels[i].x - cs.color.pixels[i].x);
  EXPECT_LT(sum / static_cast<double>(gs.color.pixels.size()), 2e-4);
  EXPECT_LT(largest_difference(gs.color, cs.color), 0.03f);
}

TEST(Sss, AnObjectOfTheBackgroundsColorStaysAsItIs) {
  Scene scene = empty_scene();
  scene.materials[0].base_color = {0, 0, 0, 1};
  scene.materials[0].metallic = 0.0f;
  scene.materials[0].emissive = scene.background = glm::vec3(0.25f, 0.5f, 0.75f);
  scene.lights[0].color = scene.ambient = glm::vec3(0.0f);
  Mesh mesh;
  add_cylinder(mesh, 0.0f, 0.1f, 12, 40, 0.02f);
  const auto shared = finish(std::move(scene), std::move(mesh));
  const Emulation msaa = run(shared, "msaa8x");
  for (const std::string variant : kVariants) {
    const Emulation e = run(shared, variant + ":mode=or,early_exit=off");
    EXPECT_GT(counters(e).sss_shaded_samples, 100u) << variant;
    EXPECT_LT(largest_difference(msaa.color, e.color), 2.5f / 255.0f) << variant;
  }
}

TEST(Sss, NothingBehindTheSceneContributes) {
  Mesh mesh;
  add_cylinder(mesh, 0.0f, 0.1f, 12, 60);
  const auto wall = static_cast<std::uint32_t>(mesh.positions.size());
  for (const glm::vec2 corner : {glm::vec2(-9, -9), glm::vec2(9, -9), glm::vec2(9, 9), glm::vec2(-9, 9)}) {
    mesh.positions.push_back({corner, 2.0f});
    mesh.normals.push_back({0, 0, 1});
  }
  mesh.indices.insert(mesh.indices.end(), {wall, wall + 1, wall + 2, wall, wall + 2, wall + 3});
  const auto scene = finish(empty_scene(), std::move(mesh));
  const Emulation msaa = run(scene, "msaa8x");
  for (const std::string variant : kVariants) {
    const Emulation e = run(scene, variant + ":mode=or,early_exit=off");
    EXPECT_GT(counters(e).sss_processed_primitives, 100u) << variant;
    EXPECT_EQ(difference(msaa.color, e.color, "image"), "") << variant;
  }
}

/// A rod that gives off light and reflects none, before black: every sample has its color, so that an image's
/// light is the area that it is shown with.
Scene shining_scene() {
  Scene scene = empty_scene();
  scene.materials[0].base_color = {0, 0, 0, 1};
  scene.materials[0].metallic = 0.0f;
  scene.materials[0].emissive = glm::vec3(1.0f);
  scene.lights[0].color = scene.ambient = scene.background = glm::vec3(0.0f);
  return scene;
}

double light_of(const Image& image) {
  double sum = 0.0;
  for (const glm::vec4& p : image.pixels) sum += p.x;
  return sum;
}

// The paper blends samples over the whole frame, which holds their triangle already: a half covered pixel
// shows 3/4 of it. Over the frame's other triangles it keeps its area.
TEST(Sss, ASilhouetteKeepsItsAreaOverTheOtherTriangles) {
  Mesh mesh;
  add_cylinder(mesh, 0.01f, 0.08f, 12, 60, 0.03f);
  const auto scene = finish(shining_scene(), std::move(mesh));
  const double truth = light_of(run(scene, "ssaa64x").color);
  for (const std::string variant : kVariants) {
    const std::string all = variant + ":mode=or,early_exit=off,k_max=64";
    EXPECT_GT(light_of(run(scene, all).color), 1.05 * truth) << variant;
    EXPECT_NEAR(light_of(run(scene, all + ",rest=others").color), truth, 0.02 * truth) << variant;
  }
}

// The wall's edge lies in the middle of a row of pixels and the rod right behind it, a third of a pixel
// thick: the pixels' farthest depth is that of what lies behind both.
TEST(Sss, WhatTheEdgeOfAWallHidesStaysHidden) {
  const float row = 2.0f * 6.0f * std::tan(0.25f) / static_cast<float>(kHeight);  // of a pixel, where z is 0
  Mesh mesh;
  add_cylinder(mesh, -0.75f * row, 0.16f * row, 12, 60);
  const auto wall = static_cast<std::uint32_t>(mesh.positions.size());
  const float nearer = (6.0f - 0.3f) / 6.0f, edge = -0.5f * row * nearer;
  for (const glm::vec2 corner :
       {glm::vec2(-9, -9), glm::vec2(9, -9), glm::vec2(9, edge), glm::vec2(-9, edge)}) {
    mesh.positions.push_back({corner, 0.3f});
    mesh.normals.push_back({0, 0, 1});
  }
  Scene scene = shining_scene();
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].emissive = glm::vec3(0.0f);
  const auto rod = static_cast<std::uint32_t>(mesh.indices.size());
  mesh.indices.insert(mesh.indices.end(), {wall, wall + 1, wall + 2, wall, wall + 2, wall + 3});
  auto finished = std::make_shared<Scene>(*finish(std::move(scene), std::move(mesh)));
  finished->meshes[0].parts = {{0, rod, 0}, {rod, 6, 1}};
  for (const std::string variant : kVariants) {
    const Emulation e = run(finished, variant + ":mode=or,early_exit=off");
    EXPECT_GT(counters(e).sss_processed_primitives, 100u) << variant;
    EXPECT_EQ(light_of(e.color), 0.0) << variant;
  }
}

TEST(Sss, ListsDoNotShowTheOrderOfInsertion) {
  const auto scene = rods();
  Scene shuffled = *scene;
  Mesh& mesh = shuffled.meshes[0];
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    triangles.push_back({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
  std::shuffle(triangles.begin(), triangles.end(), std::mt19937(3));
  mesh.indices.clear();
  for (const auto& t : triangles) mesh.indices.insert(mesh.indices.end(), t.begin(), t.end());
  for (const char* node : {"12", "16"}) {
    const std::string technique =
        std::string("sss_ppll:mode=or,early_exit=off,list_cap=64,node_bytes=") + node;
    const Emulation a = run(scene, technique);
    const Emulation b = run(std::make_shared<const Scene>(shuffled), technique);
    EXPECT_GT(counters(a).sss_list_4_to_7_pixels, 0u);
    EXPECT_EQ(counters(a).sss_truncated_pixels, 0u);
    EXPECT_EQ(difference(a.color, b.color, "image"), "") << node;
  }
}

TEST(Sss, FullListsAreCountedAndBoxesAndConservativeRasterAgree) {
  const auto scene = rods();
  const std::string all = "sss_ppll:mode=or,early_exit=off";
  const Emulation whole = run(scene, all);
  const std::uint64_t stored = counters(whole).sss_stored_fragments;
  EXPECT_EQ(counters(whole).sss_dropped_fragments, 0u);
  const Emulation little = run(scene, all + ",capacity_nodes=" + std::to_string(stored / 2));
  EXPECT_EQ(counters(little).sss_stored_fragments, stored / 2);
  EXPECT_EQ(counters(little).sss_dropped_fragments, stored - stored / 2);
  const Emulation raster = run(scene, all + ",conservative=raster");
  EXPECT_EQ(difference(whole.color, raster.color, "image"), "");
  EXPECT_EQ(counters(raster).sss_stored_fragments, stored);
  const auto fragments = [](const Emulation& e) {
    return total(pass_named(e.trace, "sample")).raster.fragments;
  };
  EXPECT_LT(fragments(raster), fragments(whole));
  const TechniqueCounters n = counters(whole);
  EXPECT_GT(n.sss_list_1_pixels + n.sss_list_2_to_3_pixels + n.sss_list_4_to_7_pixels +
                n.sss_list_8_to_15_pixels + n.sss_list_16_to_31_pixels + n.sss_list_from_32_pixels,
            0u);
}

/// Draws triangles whose criticality only their highlights decide.
std::uint64_t chosen(const std::shared_ptr<const Scene>& scene, const std::string& parameters) {
  return counters(run(scene, "sss_cs:mode=or,tri_px=0,early_exit=off," + parameters))
      .sss_processed_primitives;
}

// Width of a highlight, pixels: half the lobe's width over the turn of the normal for a pixel. On a cylinder
// whose triangles are one pixel long or thirty the normal turns across it, and equally fast.
TEST(Sss, HighlightsAreAsThinOnLongTrianglesAsOnShortOnes) {
  for (const int along : {90, 3}) {
    Mesh mesh;
    add_cylinder(mesh, 0.0f, 0.3f, 24, along);
    const auto scene = finish(empty_scene(), std::move(mesh));
    // 0.3 m are 6.27 px; facets of 15 degrees turn by 0.1604 rad/px where they face the eye. The exponent is
    // 2 / 0.35^4 - 2 = 131.3, a quarter of it for half vectors, and the lobe's width 0.4119 rad.
    const float turn = 1.0f / 6.27f, width = 0.4119f * 0.5f / turn;
    const auto share = [&](float part) {
      return static_cast<double>(chosen(scene, "hl_px=" + std::to_string(part * width))) /
             static_cast<double>(chosen(scene, "hl_px=100"));
    };
    // The nearest point is 5 % nearer than the axis. Narrower toward the limbs, by the cosine.
    EXPECT_EQ(share(1.1f), 1.0) << along;
    EXPECT_NEAR(share(0.87f), 2.0 / 3.0, 0.1) << along;  // 60 of 90 degrees lie beyond cos(30)
    EXPECT_NEAR(share(0.5f), 1.0 / 3.0, 0.1) << along;
  }
}

TEST(Sss, EarlyExitLeavesTheHighlights) {
  const auto scene = rods();
  for (const std::string variant : kVariants) {
    const Emulation off = run(scene, variant + ":mode=or,early_exit=off");
    const Emulation on = run(scene, variant + ":mode=or,early_exit=on");
    EXPECT_EQ(counters(off).sss_early_exit_primitives, 0u);
    EXPECT_GT(counters(on).sss_processed_primitives, 0u);
    EXPECT_LT(counters(on).sss_processed_primitives, counters(off).sss_processed_primitives * 9 / 10)
        << variant;
    EXPECT_EQ(counters(on).sss_processed_primitives + counters(on).sss_early_exit_primitives,
              counters(off).sss_processed_primitives);
  }
}

// 5.5: bytes beyond those of the multisampled frame and its one-sample depth, at 1280x720.
TEST(Sss, AllocatesWhatThePaperAndItsArithmeticSay) {
  const auto scene = rods();
  constexpr std::uint64_t kPixels = 1280 * 720;
  const auto extra = [&](const std::string& technique) {
    const FrameGraph graph = graph_of(scene, technique, 1280, 720);
    GpuFeatures features;
    features.conservative_raster = true;
    const std::uint64_t all = compile(graph, features, FunctionalConfig{}).allocated_bytes;
    return all - kPixels * (8 * 8 + 4 + 4);  // 8 samples of color and depth; resolved color; output
  };
  EXPECT_EQ(extra("sss_gs"), 8 * kPixels);                                         // 7.03 MiB
  EXPECT_EQ(extra("sss_cs"), 16 * kPixels);                                        // 14.06 MiB
  EXPECT_EQ(extra("sss_ppll"), 4 * kPixels + 4 * 16 * kPixels + 4);                // 59.8 MiB
  EXPECT_EQ(extra("sss_ppll:node_bytes=12"), 4 * kPixels + 4 * 12 * kPixels + 4);  // 45.7 MiB
  const std::uint64_t budget = 27u << 20;
  EXPECT_LE(extra("sss_ppll:budget_mib=27"), budget + 4);
  EXPECT_GT(extra("sss_ppll:budget_mib=27"), budget - 16);
}

// Exponent 0, normals that do not differ, triangles without area and seen edge on: each divides by it.
TEST(Sss, DegenerateTrianglesStayNumbers) {
  Mesh mesh;
  add_cylinder(mesh, 0.0f, 0.2f, 12, 8);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const glm::vec3 p : {glm::vec3(0, 0, 0.5f), glm::vec3(0.4f, 0, 0.5f), glm::vec3(0.8f, 0, 0.5f),
                            glm::vec3(0, 0.3f, 0.5f), glm::vec3(0, 0.3f, -0.5f), glm::vec3(0, 0.9f, 0.1f)}) {
    mesh.positions.push_back(p);
    mesh.normals.push_back(glm::normalize(glm::vec3(0.2f * p.x, 0.4f * p.z, 1)));
  }
  mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2, first + 3, first + 4, first + 5,  //
                                           first, first, first});
  Scene scene = empty_scene();
  scene.materials[0].roughness = 1.0f;            // the exponent is 2 / 1 - 2
  scene.materials[0].emissive = glm::vec3(0.1f);  // what is not a number is stored as 0
  scene.background = glm::vec3(0.25f);
  scene.materials[0].double_sided = true;
  const auto rough = finish(scene, mesh);
  for (glm::vec3& n : mesh.normals) n = glm::vec3(0, 0, 1);
  const auto flat = finish(scene, mesh);
  for (const std::string variant : kVariants)
    for (const std::string rest : {"frame", "others"})
      for (const std::string exit : {"on", "off"}) {
        const std::string text =
            variant + ":theta_c=0.01,mode=or,tri_px=1000,hl_px=1000,rest=" + rest + ",early_exit=" + exit;
        for (const auto& s : {rough, flat}) {
          const Image image = run(s, text).color;
          for (const glm::vec4& p : image.pixels) ASSERT_GT(p.x, 0.0f) << text;
          EXPECT_NEAR(image.at(0, 0).x, 0.25f, 0.005f) << text;
        }
      }
}

TEST(Sss, LongListsAreCutAndCounted) {
  const auto scene = rods();
  const std::string all = "sss_ppll:mode=or,early_exit=off,list_cap=";
  const TechniqueCounters whole = counters(run(scene, all + "64")), one = counters(run(scene, all + "1"));
  EXPECT_EQ(whole.sss_truncated_pixels, 0u);
  const std::uint64_t longer = whole.sss_list_2_to_3_pixels + whole.sss_list_4_to_7_pixels +
                               whole.sss_list_8_to_15_pixels + whole.sss_list_16_to_31_pixels +
                               whole.sss_list_from_32_pixels;
  EXPECT_GT(longer, 100u);
  EXPECT_EQ(one.sss_truncated_pixels, longer);
  EXPECT_EQ(one.sss_list_1_pixels, longer + whole.sss_list_1_pixels);
}

// 5.4: where the covered parts add up to the pixel, the frame below shows nothing of itself.
TEST(Sss, FullListsLeaveNothingOfTheFrame) {
  Mesh mesh;
  add_cylinder(mesh, 0.0f, 0.9f, 48, 40);
  const auto scene = finish(empty_scene(), std::move(mesh));
  const std::string all = "sss_ppll:mode=or,tri_px=1000,early_exit=off,rest=";
  const Image frame = run(scene, all + "frame").color, others = run(scene, all + "others").color;
  int shaded = 0;
  for (int y = kHeight / 2 - 12; y < kHeight / 2 + 12; ++y)  // the cylinder reaches over 18 rows on each side
    for (int x = 0; x < kWidth; ++x) {
      shaded += frame.at(x, y).x > 0.0f ? 1 : 0;
      for (int c = 0; c < 3; ++c) ASSERT_EQ(frame.at(x, y)[c], others.at(x, y)[c]) << x << ", " << y;
    }
  EXPECT_GT(shaded, 1000);
  EXPECT_GT(largest_difference(frame, run(scene, "msaa8x").color), 1.0f / 255.0f);
}

TEST(Sss, ConservativeRasterNeedsTheGpu) {
  try {
    emulate(graph_of(rods(), "sss_ppll:conservative=raster"), GpuFeatures{}, FunctionalConfig{}, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().front().code, "G006");
  }
}

/// Coefficient of variation along a thin rod of the light of each column.
double beads(const Image& image) {
  double sum = 0.0, squares = 0.0;
  int columns = 0;
  for (int x = 8; x < image.width - 8; ++x) {
    double light = 0.0;
    for (int y = 0; y < image.height; ++y) light += image.at(x, y).x;
    sum += light;
    squares += light * light;
    ++columns;
  }
  const double mean = sum / columns;
  return std::sqrt(std::max(0.0, squares / columns - mean * mean)) / mean;
}

TEST(Sss, BeadsGoFromAThinHighlight) {
  Scene scene = empty_scene();
  scene.ambient = glm::vec3(0.0f);
  scene.materials[0].roughness = 0.2f;
  Mesh mesh;
  add_cylinder(mesh, 0.02f, 0.012f, 8, 200, 0.03f);
  const auto shared = finish(std::move(scene), std::move(mesh));
  const double msaa = beads(run(shared, "msaa8x").color), ssaa16 = beads(run(shared, "ssaa16x").color),
               ssaa64 = beads(run(shared, "ssaa64x").color);
  for (const std::string variant : kVariants) {
    const double b = beads(run(shared, variant).color);
    RecordProperty(variant, std::to_string(b));
    EXPECT_LT(b, msaa) << variant;
    EXPECT_LE(b, ssaa16) << variant << ", 64x " << ssaa64 << ", msaa " << msaa;
    EXPECT_LE(b, 1.1 * ssaa64) << variant;
  }
}

}  // namespace
}  // namespace hwsim::test
