// Wire anti-aliasing (docs/techniques/wire.md): no gaps, the energy of the true width, wide wires as they
// were.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "algos/frame_run.h"

namespace hwsim::test {
namespace {
using namespace pipeline;

constexpr int kWidth = 64, kHeight = 48;
constexpr float kFovY = 0.6f;

/// A wire along x through (0, y, 0), seen from z = distance; white and lit by nothing but itself.
struct WireScene {
  float radius = 0.01f, distance = 10.0f, y = 0.0f, slope = 0.0f;
  bool emissive = true;
  bool wall = false;  ///< a black one behind it
};

float pixel_height_m(float distance) { return 2.0f * distance * std::tan(0.5f * kFovY) / kHeight; }

std::shared_ptr<const Scene> make(const WireScene& w) {
  constexpr int kSides = 32, kAlong = 4;
  Scene scene;
  scene.name = "wire";
  Mesh mesh;
  const glm::vec3 axis = glm::normalize(glm::vec3(1.0f, w.slope, 0.0f)),
                  up = glm::cross(glm::vec3(0, 0, 1), axis);
  const float half = 0.7f * w.distance;
  for (int i = 0; i <= kAlong; ++i)
    for (int j = 0; j < kSides; ++j) {
      const float a = 6.2831853f * static_cast<float>(j) / kSides;
      const glm::vec3 n = std::sin(a) * up + std::cos(a) * glm::vec3(0, 0, 1);
      const float along = half * (2.0f * static_cast<float>(i) / kAlong - 1.0f);
      mesh.positions.push_back(glm::vec3(0, w.y, 0) + along * axis + w.radius * n);
      mesh.normals.push_back(n);
      mesh.tangents.push_back(glm::vec4(axis, 1.0f));
      mesh.radius.push_back(w.radius);
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * kSides + j % kSides); };
  for (int i = 0; i < kAlong; ++i)
    for (int j = 0; j < kSides; ++j)
      mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j + 1), at(i + 1, j), at(i, j),
                                               at(i, j + 1), at(i + 1, j + 1)});
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {  // outside faces turn counterclockwise
    const glm::vec3 &a = mesh.positions[mesh.indices[i]], &b = mesh.positions[mesh.indices[i + 1]],
                    &c = mesh.positions[mesh.indices[i + 2]];
    if (glm::dot(glm::cross(b - a, c - a), mesh.normals[mesh.indices[i]]) < 0.0f)
      std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  }
  mesh.parts = {{0, static_cast<std::uint32_t>(mesh.indices.size()), 0}};
  mesh.vertex_bytes = 40;
  mesh.bounds_min = glm::vec3(-half, w.y - 1.0f, -1.0f);
  mesh.bounds_max = glm::vec3(half, w.y + 1.0f, 1.0f);
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({0, glm::mat4(1.0f), "wire"});
  if (w.wall) {
    Mesh wall;
    const float far = 4.0f * w.distance;
    wall.positions = {{-far, -far, -1}, {far, -far, -1}, {far, far, -1}, {-far, far, -1}};
    wall.normals.assign(4, glm::vec3(0, 0, 1));
    wall.indices = {0, 1, 2, 0, 2, 3};
    wall.parts = {{0, 6, 1}};
    wall.vertex_bytes = 24;
    wall.bounds_min = glm::vec3(-far, -far, -1);
    wall.bounds_max = glm::vec3(far, far, -1);
    scene.meshes.push_back(std::move(wall));
    scene.instances.push_back({1, glm::mat4(1.0f), "wall"});
  }
  scene.materials.resize(2);
  scene.materials[1].base_color = glm::vec4(0, 0, 0, 1);
  scene.materials[1].metallic = 0.0f;
  Material& material = scene.materials[0];
  material.metallic = 0.0f;
  material.base_color = w.emissive ? glm::vec4(0, 0, 0, 1) : glm::vec4(0.8f, 0.7f, 0.6f, 1.0f);
  material.emissive = glm::vec3(w.emissive ? 1.0f : 0.0f);
  scene.samplers.emplace_back();
  Light sun;
  sun.color = glm::vec3(w.emissive ? 0.0f : 1.0f);
  sun.direction = glm::normalize(glm::vec3(0.3f, -0.8f, -0.5f));
  scene.lights = {sun};
  scene.ambient = scene.background = glm::vec3(0.0f);
  Camera camera;
  camera.view_from_world = glm::lookAt(glm::vec3(0, 0, w.distance), glm::vec3(0.0f), glm::vec3(0, 1, 0));
  camera.fov_y_rad = kFovY;
  camera.near_m = 0.01f;
  camera.far_m = 1e5f;
  scene.cameras = {camera};
  return std::make_shared<const Scene>(std::move(scene));
}

Emulation run(const WireScene& wire, const std::string& technique, const GpuFeatures& features = {}) {
  algos::FrameRequest request;
  request.scene = make(wire);
  request.width_px = kWidth;
  request.height_px = kHeight;
  request.features = features;
  const FrameGraph graph = algos::build_frame(algos::parse_technique(technique), request);
  return emulate(graph, features, FunctionalConfig{}, {});
}

double column(const Image& image, int x) {
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y) sum += image.at(x, y).x;
  return sum;
}

/// The mean of all columns: single ones of a slanted wire depend on where samples lie.
double mean_column(const Image& image) {
  double sum = 0.0;
  for (int x = 0; x < image.width; ++x) sum += column(image, x);
  return sum / image.width;
}

TEST(Wire, ACrossSectionHasTheEnergyOfTheTrueWidthAtEveryDistance) {
  for (const float width_px : {0.15f, 0.4f, 0.8f})
    for (const float distance : {2.0f, 20.0f, 500.0f})
      for (int step = 0; step < 8; ++step) {
        WireScene wire;
        wire.distance = distance;
        wire.radius = 0.5f * width_px * pixel_height_m(distance);
        wire.y = pixel_height_m(distance) * static_cast<float>(step) / 8.0f;
        const Image image = run(wire, "wire_aa:lighting=none+msaa8x").color;
        for (const int x : {5, 31, 60})
          EXPECT_NEAR(column(image, x), width_px, 0.05 * width_px) << distance << " m, offset " << step;
      }
}

// Vertices snap to 1/256 pixel, so that a slanted wire of one pixel may come out a trace thinner than the
// step between two pixel centers: 2 of 3072 columns. Two steps of the grid more leave none.
TEST(Wire, NoColumnIsEverEmpty) {
  int plain_gaps = 0, gaps = 0;
  for (const float slope : {0.0f, 0.03f, 0.4f})
    for (int step = 0; step < 16; ++step) {
      WireScene wire;
      wire.slope = slope;
      wire.radius = 0.1f * pixel_height_m(wire.distance);
      wire.y = pixel_height_m(wire.distance) * static_cast<float>(step) / 16.0f;
      const Image faded = run(wire, "wire_aa").color, plain = run(wire, "none").color;
      const Image wider = run(wire, "wire_aa:width_px=1.0078125").color;
      for (int x = 0; x < kWidth; ++x) {
        EXPECT_GT(column(wider, x), 0.0) << x << ", offset " << step << ", slope " << slope;
        gaps += column(faded, x) == 0.0 ? 1 : 0;
        plain_gaps += column(plain, x) == 0.0 ? 1 : 0;
      }
    }
  EXPECT_LE(gaps, 3);
  EXPECT_GT(plain_gaps, 500) << "the scene is a hard one";
}

TEST(Wire, FadesSmoothlyToNothing) {
  double last = 1e9;
  for (const float distance : {5.0f, 10.0f, 20.0f, 40.0f, 80.0f, 160.0f, 5000.0f}) {
    WireScene wire;
    wire.distance = distance;
    wire.radius = 0.005f;
    const double sum = column(run(wire, "wire_aa:lighting=none+msaa8x").color, 20);
    EXPECT_LT(sum, last) << distance;
    last = sum;
  }
  EXPECT_LT(last, 0.02);
}

TEST(Wire, WideWiresAreAsPlainRenderingHasThem) {
  WireScene wire;
  wire.emissive = false;
  wire.radius = 4.0f * pixel_height_m(wire.distance);
  wire.slope = 0.2f;
  for (const std::string base : {"none", "msaa4x", "deferred_simple_complex"}) {
    const Emulation plain = run(wire, base);
    for (const char* options :
         {"lighting=none", "lighting=both", "lighting=flatten,fade=pixel", "z_write=on"}) {
      const Emulation e = run(wire, std::string("wire_aa:") + options + "+" + base);
      if (base == "deferred_simple_complex") continue;  // lit forward: not through the G-buffer's encodings
      EXPECT_EQ(difference(plain.color, e.color, "image"), "") << base << ", " << options;
    }
  }
}

// Fragments of thin wires are discarded where wide ones are drawn; that must leave depth as it was.
TEST(Wire, ThinWiresBeforeAWallAreWhole) {
  WireScene wire;
  wire.wall = true;
  wire.slope = 0.3f;
  wire.radius = 0.2f * pixel_height_m(wire.distance);
  for (const std::string base : {"none", "msaa8x"}) {
    const Emulation split = run(wire, "wire_aa+" + base), off = run(wire, "wire_aa:z_write=off+" + base);
    EXPECT_EQ(difference(split.color, off.color, "image"), "") << base;
    for (int x = 0; x < kWidth; ++x) EXPECT_GT(column(split.color, x), 0.05) << x;
  }
}

TEST(Wire, ThinWiresOverDeferredLightingAreThoseOfForward) {
  WireScene wire;
  wire.radius = 0.2f * pixel_height_m(wire.distance);
  const Emulation forward = run(wire, "wire_aa+msaa8x"), deferred = run(wire, "wire_aa+deferred");
  EXPECT_GT(column(deferred.color, 30), 0.2);
  EXPECT_NEAR(column(deferred.color, 30), column(forward.color, 30), 0.02);
}

// Section 6.2.4 of the chapter. What is wider than a pixel goes into the G-buffer: nothing of it is left for
// the pass that blends. What is thinner has the frame's samples, however few the lit image has: along a
// slanted wire a column holds parts of two or three pixels, not one pixel.
TEST(Wire, EveryBaseBlendsWhatIsThinAndStoresWhatIsWide) {
  const char* const bases[] = {"deferred",
                               "deferred_simple_complex",
                               "deferred_simple_complex:lighting=compute",
                               "sbaa_top:n=4",
                               "sbaa_merge",
                               "sbaa_merge:pack_id_normal=on",
                               "agaa",
                               "agaa:c=4",
                               "agaa:msaa=32",
                               "agaa:ndf=lean",
                               "agaa:accumulate=atomics"};
  WireScene thin;
  thin.slope = 0.3f;
  thin.radius = 0.3f * pixel_height_m(thin.distance);
  WireScene wide = thin;
  wide.radius = 2.0f * pixel_height_m(wide.distance);
  const auto lit_pixels = [](const Image& image) {
    int lit = 0;
    for (const glm::vec4& p : image.pixels) lit += p.x > 0.01f ? 1 : 0;
    return lit;
  };
  const Image reference = run(thin, "wire_aa:lighting=none+msaa8x").color;
  ASSERT_GT(lit_pixels(reference), kWidth * 3 / 2);
  for (const std::string base : bases) {
    const Emulation e = run(thin, "wire_aa+" + base, every_feature(8));
    EXPECT_NEAR(lit_pixels(e.color), lit_pixels(reference), kWidth / 3) << base;
    EXPECT_NEAR(mean_column(e.color), mean_column(reference), 0.03) << base;
    const Emulation whole = run(wide, "wire_aa+" + base, every_feature(8)),
                    plain = run(wide, base, every_feature(8));
    for (const PassWork& pass : whole.trace.passes)
      if (pass.name == "wires") {
        EXPECT_EQ(total(pass).ps.invocations, 0u) << base;
      }
    EXPECT_NEAR(mean_column(whole.color), mean_column(plain.color), 0.02) << base;
  }
}

TEST(Wire, ManySamplesHaveWiresToo) {
  WireScene wire;
  wire.slope = 0.3f;
  wire.radius = 0.3f * pixel_height_m(wire.distance);
  const Image reference = run(wire, "wire_aa+msaa8x").color;
  for (const std::string base : {"msaa16x", "msaa32x", "csaa", "ssaa4x", "sss_cs"})
    EXPECT_NEAR(mean_column(run(wire, "wire_aa+" + base, every_feature(8)).color), mean_column(reference),
                base == "csaa" ? 0.04 : 0.03)  // csaa keeps fewer colors than coverage positions
        << base;
}

// The G-buffer's lighting is that of any surface, so its normals bend: thinner than four pixels a wire is lit
// more evenly than plain rendering lights it.
TEST(Wire, StoredNormalsBendAsWiresThin) {
  for (const float width_px : {1.5f, 5.0f}) {
    WireScene wire;
    wire.emissive = false;
    wire.radius = 0.5f * width_px * pixel_height_m(wire.distance);
    const double bent = column(run(wire, "wire_aa+deferred").color, 30),
                 plain = column(run(wire, "wire_aa:lighting=none+deferred").color, 30);
    if (width_px < 4.0f)
      EXPECT_GT(std::abs(bent - plain), 0.02);
    else
      EXPECT_NEAR(bent, plain, 1e-3);
  }
}

TEST(Wire, SoftLightingTakesOverAsAWireThins) {
  const auto light = [](const char* lighting, float width_px) {
    WireScene wire;
    wire.emissive = false;
    wire.radius = 0.5f * width_px * pixel_height_m(wire.distance);
    return column(run(wire, std::string("wire_aa:lighting=") + lighting + "+msaa8x").color, 30) / width_px;
  };
  for (const char* lighting : {"half_lambert", "flatten", "both"}) {
    const double thin = std::abs(light(lighting, 1.0f) - light("none", 1.0f));
    EXPECT_GT(thin, 0.02) << lighting;
    EXPECT_NEAR(light(lighting, 4.5f), light("none", 4.5f), 1e-6) << lighting;
  }
}

TEST(Wire, HazardsEndInNumbers) {
  for (const WireScene& wire : {WireScene{0.0f, 10.0f, 0.0f, 0.0f}, WireScene{0.0f, 0.02f, 0.0f, 0.0f},
                                WireScene{0.05f, 0.03f, 0.0f, 0.1f}}) {
    for (const char* options : {"lighting=both", "fade=pixel,lighting=both", "z_write=off"}) {
      const Image image = run(wire, std::string("wire_aa:") + options + "+msaa2x").color;
      for (const glm::vec4& p : image.pixels) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z + p.w)) << options;
    }
  }
}

// On the scene that ships, both soft forms change what is seen of the wires.
TEST(Wire, LightingShowsOnTheGeneratedScene) {
  algos::FrameRequest request;
  request.scene = generated_scene("wires");
  request.width_px = 320;
  request.height_px = 180;
  request.shadows = false;
  const auto image = [&](const std::string& lighting) {
    const std::string technique = "wire_aa:lighting=" + lighting + "+msaa4x";
    const FrameGraph graph = algos::build_frame(algos::parse_technique(technique), request);
    return emulate(graph, request.features, request.functional, {}).color;
  };
  const Image plain = image("none");
  for (const char* lighting : {"half_lambert", "flatten", "both"}) {
    const Image soft = image(lighting);
    int changed = 0;
    for (std::size_t i = 0; i < plain.pixels.size(); ++i) {
      const auto code = [&](const Image& of) { return 255.0f * srgb_from_linear(of.pixels[i].y); };
      changed += std::abs(code(soft) - code(plain)) > 2.0f ? 1 : 0;
    }
    EXPECT_GT(changed, 100) << lighting;
  }
}

TEST(Wire, FartherWiresAreDrawnFirst) {
  const auto wires = generated_scene("wires:poles=3");
  int checked = 0;
  for (int i = 0; i < static_cast<int>(wires->instances.size()); ++i) {
    const Mesh& mesh =
        wires->meshes[static_cast<std::size_t>(wires->instances[static_cast<std::size_t>(i)].mesh)];
    if (mesh.radius.empty()) continue;
    algos::FrameRequest request;
    request.scene = wires;
    const FrameGraph graph = algos::build_frame(algos::parse_technique("wire_aa+none"), request);
    for (const Pass& pass : graph.passes()) {
      if (pass.name != "wires") continue;
      const auto& list = pass.batches[0].draws[0].list;
      ASSERT_TRUE(list);
      EXPECT_EQ(list->indices.size(), mesh.indices.size());
      const auto z = [&](std::size_t at) {
        return (wires->cameras[0].view_from_world * glm::vec4(mesh.positions[list->indices[at]], 1.0f)).z;
      };
      EXPECT_LT(z(0), z(list->indices.size() - 1));
      ++checked;
    }
  }
  EXPECT_EQ(checked, 1);
}

}  // namespace
}  // namespace hwsim::test
