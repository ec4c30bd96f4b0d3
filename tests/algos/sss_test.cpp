// Selective shader supersampling (docs/techniques/sss.md#tests): weights, visibility, memory, and beads on a
// thin highlight.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "algos/sss/classify.h"
#include "algos/sss/shaders/counters.h"
#include "algos/sss/shaders/programs.h"
#include "algos/sss_scenes.h"

// One vector target is enough here: without foreach_target.
#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

namespace hwsim::test {
namespace {
using namespace pipeline;
using namespace sss;

const char* const kVariants[] = {"sss_gs", "sss_cs", "sss_ppll"};

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
    const Emulation small = run(scene, variant + ":tri_px=0,hl_px=0");
    EXPECT_EQ(difference(msaa.color, small.color, "image"), "") << variant;
    EXPECT_GT(counters(small)[algos::SssCounters::sss_tested_primitives], 0u);
    EXPECT_EQ(counters(small)[algos::SssCounters::sss_processed_primitives], 0u);
    EXPECT_EQ(counters(small)[algos::SssCounters::sss_shaded_samples], 0u);
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
    batch.geometry = &algos::sss_points_program(algos::SssVertex::plain, algos::SssPointDepth::shader, 72);
    batch.geometry_uniforms = u;
    batch.fragment_uniforms = std::make_shared<int>(0);
    batch.state.blend = {{true, BlendFactor::one, BlendFactor::one, BlendFactor::one, BlendFactor::one, 0xf}};
    frame.draw("points", {batch});
    const Emulation e = frame.run();
    double sum = 0.0, points = 0.0;
    for (const glm::vec4& p : e.color.pixels) sum += p.x;
    points = static_cast<double>(counters(e)[algos::SssCounters::sss_point_samples]);
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
  const Emulation gs = run(scene, "sss_gs" + parameters + ",depth=shader"),
                  cs = run(scene, "sss_cs" + parameters);
  EXPECT_GT(counters(gs)[algos::SssCounters::sss_point_samples], 1000u);
  EXPECT_EQ(counters(gs)[algos::SssCounters::sss_point_samples],
            counters(cs)[algos::SssCounters::sss_point_samples]);
  EXPECT_EQ(counters(gs)[algos::SssCounters::sss_processed_primitives],
            counters(cs)[algos::SssCounters::sss_processed_primitives]);
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
    EXPECT_GT(counters(e)[algos::SssCounters::sss_shaded_samples], 100u) << variant;
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
    EXPECT_GT(counters(e)[algos::SssCounters::sss_processed_primitives], 100u) << variant;
    EXPECT_EQ(difference(msaa.color, e.color, "image"), "") << variant;
  }
}

double light_of(const Image& image) {
  double sum = 0.0;
  for (const glm::vec4& p : image.pixels) sum += p.x;
  return sum;
}

// Marks choose triangles once more, and draw none of their points.
TEST(Sss, MarksDoNotCountTrianglesAgain) {
  const auto scene = rods();
  for (const std::string variant : kVariants) {
    const TechniqueCounters frame = counters(run(scene, variant + ":rest=frame")),
                            others = counters(run(scene, variant));
    EXPECT_GT(frame[algos::SssCounters::sss_processed_primitives], 0u) << variant;
    EXPECT_EQ(others[algos::SssCounters::sss_tested_primitives],
              frame[algos::SssCounters::sss_tested_primitives])
        << variant;
    EXPECT_EQ(others[algos::SssCounters::sss_processed_primitives],
              frame[algos::SssCounters::sss_processed_primitives])
        << variant;
    EXPECT_EQ(others[algos::SssCounters::sss_shaded_samples], frame[algos::SssCounters::sss_shaded_samples])
        << variant;
  }
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
    EXPECT_GT(light_of(run(scene, all + ",rest=frame").color), 1.05 * truth) << variant;
    EXPECT_NEAR(light_of(run(scene, all).color), truth, 0.02 * truth) << variant;
  }
}

// The wall's edge lies in the middle of a row of pixels and the rod right behind it, a third of a pixel
// thick: the pixels' farthest depth is that of what lies behind both.
TEST(Sss, WhatTheEdgeOfAWallHidesStaysHidden) {
  const float row =
      2.0f * 6.0f * std::tan(0.25f) / static_cast<float>(kSssHeight);  // height of a pixel, where z is 0
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
  // A point that the hardware tests is a square, which reaches past the wall's edge.
  for (const std::string variant : {"sss_gs:depth=shader", "sss_cs:m", "sss_ppll:m"}) {
    const std::string technique = variant.substr(0, variant.find(":m"));
    const Emulation e =
        run(finished, technique + (technique == variant ? "," : ":") + "mode=or,early_exit=off");
    EXPECT_GT(counters(e)[algos::SssCounters::sss_processed_primitives], 100u) << variant;
    EXPECT_EQ(light_of(e.color), 0.0) << variant;
  }
}

// The paper's 4.1: the depth buffer is locked, and the hardware tests points that come a little forward.
TEST(Sss, TheHardwareTestsPointsAgainstTheFramesSamples) {
  const auto scene = rods();
  const std::string parameters = ":mode=or,hl_px=2,early_exit=off,k_max=48";
  const Emulation fixed = run(scene, "sss_gs" + parameters),
                  loads = run(scene, "sss_gs" + parameters + ",depth=shader");
  const PassCounters n = total(test::pass_named(fixed.trace, "sample")),
                     m = total(test::pass_named(loads.trace, "sample"));
  EXPECT_EQ(n.tex.fetched_32bit_texels, 0u);
  EXPECT_EQ(n.ps.discarded_invocations, 0u);
  EXPECT_GT(n.zrop.early_z_tested_samples, 8 * n.technique[algos::SssCounters::sss_point_samples] * 9 / 10);
  EXPECT_EQ(n.zrop.written_samples, 0u);
  EXPECT_GT(m.tex.fetched_32bit_texels, 0u);
  EXPECT_EQ(m.zrop.early_z_tested_samples, 0u);
  EXPECT_EQ(n.technique[algos::SssCounters::sss_point_samples],
            m.technique[algos::SssCounters::sss_point_samples]);
  // A point's square is spread over the pixels that it lies on: as bright, a little wider.
  EXPECT_NEAR(light_of(fixed.color), light_of(loads.color), 0.03 * light_of(loads.color));
}

// "Count 8, quality 32": 8 samples and 32 positions of coverage, where the GPU has them.
TEST(Sss, TheFrameBelowIsCoverageSampledWhereTheGpuCan) {
  const auto scene = rods();
  const auto map_of = [&](const std::string& technique, int positions) {
    algos::FrameRequest request;
    request.scene = scene;
    request.width_px = kSssWidth;
    request.height_px = kSssHeight;
    request.features.coverage_samples_max = positions;
    const FrameGraph graph = algos::build_frame(algos::parse_technique(technique), request);
    compile(graph, request.features, request.functional);
    for (const ImageDesc& image : graph.images())
      if (image.name == "multisampled_color") return image.coverage_samples;
    return -1;
  };
  for (const std::string variant : kVariants) {
    EXPECT_EQ(map_of(variant, 32), 32) << variant;
    EXPECT_EQ(map_of(variant, 16), 0) << variant;
    EXPECT_EQ(map_of(variant + ":base=msaa8x", 32), 0) << variant;
    EXPECT_THROW(map_of(variant + ":base=csaa32x", 16), InputError) << variant;
  }
}

/// Draws triangles whose criticality only their highlights decide.
std::uint64_t chosen(const std::shared_ptr<const Scene>& scene, const std::string& parameters) {
  return counters(run(scene, "sss_cs:mode=or,tri_px=0,early_exit=off,rho_min=0," +
                                 parameters))[algos::SssCounters::sss_processed_primitives];
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

// Points thinner than the frame's samples would replace them by less: triangles of more than k_max / rho_min
// pixels stay the frame's. Those of the cylinder whose triangles are thirty pixels long do.
TEST(Sss, TrianglesTooLargeForTheirPointsAreLeftToTheFrame) {
  for (const int along : {90, 3}) {
    Mesh mesh;
    add_cylinder(mesh, 0.0f, 0.3f, 24, along);
    const auto scene = finish(empty_scene(), std::move(mesh));
    const auto sampled = [&](const std::string& technique) {
      return counters(run(scene, technique))[algos::SssCounters::sss_processed_primitives];
    };
    const std::string all = ":tri_px=100,early_exit=off,k_max=32,rho_min=";
    for (const std::string variant : {"sss_gs", "sss_cs"}) {
      EXPECT_GT(sampled(variant + all + "0"), 0u) << variant << along;
      if (along == 90)
        EXPECT_EQ(sampled(variant + all + "8"), sampled(variant + all + "0")) << variant;
      else
        EXPECT_LT(sampled(variant + all + "8"), sampled(variant + all + "0")) << variant;
    }
    EXPECT_EQ(sampled("sss_ppll:tri_px=100,early_exit=off,rho_min=256"),
              sampled("sss_ppll:tri_px=100,early_exit=off,rho_min=0"));
    // What is left out shows the frame's own samples, marks or none.
    const std::string none = "sss_cs:tri_px=100,early_exit=off,k_min=1,k_max=1,rho_min=256";
    if (along == 3) {
      EXPECT_EQ(sampled(none), 0u);
      EXPECT_EQ(largest_difference(run(scene, none + ",base=msaa8x").color, run(scene, "msaa8x").color),
                0.0f);
    }
  }
}

TEST(Sss, EarlyExitLeavesTheHighlights) {
  const auto scene = rods();
  for (const std::string variant : kVariants) {
    const Emulation off = run(scene, variant + ":mode=or,early_exit=off");
    const Emulation on = run(scene, variant + ":mode=or,early_exit=on");
    EXPECT_EQ(counters(off)[algos::SssCounters::sss_early_exit_primitives], 0u);
    EXPECT_GT(counters(on)[algos::SssCounters::sss_processed_primitives], 0u);
    EXPECT_LT(counters(on)[algos::SssCounters::sss_processed_primitives],
              counters(off)[algos::SssCounters::sss_processed_primitives] * 9 / 10)
        << variant;
    EXPECT_EQ(counters(on)[algos::SssCounters::sss_processed_primitives] +
                  counters(on)[algos::SssCounters::sss_early_exit_primitives],
              counters(off)[algos::SssCounters::sss_processed_primitives]);
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
  const std::string paper = ":rest=frame", lists = "sss_ppll:rest=frame,";
  EXPECT_EQ(extra("sss_gs" + paper + ",depth=shader"), 8 * kPixels);              // 7.03 MiB
  EXPECT_EQ(extra("sss_gs" + paper), (8 * 8 + 8) * kPixels);                      // a sum for each sample
  EXPECT_EQ(extra("sss_cs" + paper), 16 * kPixels);                               // 14.06 MiB
  EXPECT_EQ(extra("sss_ppll" + paper), 4 * kPixels + 4 * 16 * kPixels + 4);       // 59.8 MiB
  EXPECT_EQ(extra(lists + "node_bytes=12"), 4 * kPixels + 4 * 12 * kPixels + 4);  // 45.7 MiB
  const std::uint64_t budget = 27u << 20;
  EXPECT_LE(extra(lists + "budget_mib=27"), budget + 4);
  EXPECT_GT(extra(lists + "budget_mib=27"), budget - 16);
  // Over the frame's other triangles: a mark for each sample.
  EXPECT_EQ(extra("sss_cs"), (16 + 8) * kPixels);
  EXPECT_EQ(extra(lists + "node_bytes=32"), 4 * kPixels + 4 * 32 * kPixels + 4 + 8 * kPixels);
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
    // 16 places of a pixel make the beads of ssaa16x.
    const double b = beads(run(shared, variant == "sss_ppll" ? variant + ":m=8" : variant).color);
    RecordProperty(variant, std::to_string(b));
    EXPECT_LT(b, msaa) << variant;
    EXPECT_LE(b, ssaa16) << variant << ", 64x " << ssaa64 << ", msaa " << msaa;
    EXPECT_LE(b, 1.1 * ssaa64) << variant;
  }
}

}  // namespace
}  // namespace hwsim::test
