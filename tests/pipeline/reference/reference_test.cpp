#include "pipeline/reference/reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace hwsim::pipeline {
namespace {

// A quad from (-1,-1,0) to (1,1,0), front to +z, uv (0,0) at the lower left corner, colors red and green
// along x and y.
Mesh quad_mesh(int material) {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.tangents.assign(4, {1, 0, 0, -1});
  mesh.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.uv1 = {{0, 0}, {0, 2}, {4, 2}, {4, 0}};
  mesh.colors = {{0, 0, 0, 1}, {1, 0, 0, 1}, {1, 1, 0, 1}, {0, 1, 0, 1}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  mesh.parts = {{0, 6, material}};
  return mesh;
}

Mesh cube_mesh(int material) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  for (const glm::vec3& p : mesh.positions) mesh.normals.push_back(p / std::sqrt(3.0f));
  mesh.indices = {4, 5, 7, 4, 7, 6, 1, 0, 2, 1, 2, 3, 5, 1, 3, 5, 3, 7,
                  0, 4, 6, 0, 6, 2, 6, 7, 3, 6, 3, 2, 0, 1, 5, 0, 5, 4};
  mesh.parts = {{0, 12, material}, {12, 24, material}};
  return mesh;
}

glm::mat4 moved(float x, float y, float z) {
  glm::mat4 matrix(1.0f);
  matrix[3] = {x, y, z, 1.0f};
  return matrix;
}

glm::mat4 scaled(float x, float y, float z) {
  glm::mat4 matrix(1.0f);
  matrix[0].x = x, matrix[1].y = y, matrix[2].z = z;
  return matrix;
}

// The camera stands at the origin and looks along -z; 90 degrees: at distance d the image shows 2 d in
// height.
Scene empty_scene() {
  Scene scene;
  scene.materials.resize(1);
  scene.cameras.resize(1);
  scene.cameras[0].fov_y_rad = std::numbers::pi_v<float> / 2;
  scene.background = {0.25f, 0.5f, 0.75f};
  return scene;
}

Scene quad_scene(float distance) {
  Scene scene = empty_scene();
  scene.meshes = {quad_mesh(0)};
  scene.instances = {{0, moved(0, 0, -distance), "quad"}};
  return scene;
}

ReferenceOptions options_of(int width, int height, int samples) {
  ReferenceOptions options;
  options.width = width;
  options.height = height;
  options.samples = samples;
  return options;
}

// What the middle of the image shows.
Visibility seen_in_the_middle(const Scene& scene) {
  ReferenceOptions options = options_of(1, 1, 1);
  options.offsets_px = {{0.01f, 0.03f}};
  return trace_visibility(ReferenceScene(scene), options).front();
}

void shade_white(std::span<const SurfaceHit>, std::span<glm::vec4> colors) {
  for (glm::vec4& color : colors) color = glm::vec4(1.0f);
}

TEST(CameraRays, PassThroughTheWindowPositionAtTheirDistanceAlongTheAxis) {
  Camera camera;
  camera.fov_y_rad = 0.9f;
  camera.view_from_world = moved(3, -2, 7);
  const CameraRays rays(camera, 200, 100);
  for (const auto& [x, y] : {std::pair(0.0, 0.0), std::pair(133.25, 20.5), std::pair(200.0, 100.0)}) {
    const Ray ray = rays.through(x, y).ray;
    const glm::vec4 view = camera.view_from_world * glm::vec4(ray.origin + 6.5f * ray.direction, 1.0f);
    EXPECT_NEAR(view.z, -6.5f, 1e-5f);
    const float scale = 1.0f / std::tan(0.45f);
    EXPECT_NEAR((view.x * scale / 2.0f / 6.5f + 1.0f) * 100.0f, x, 1e-3);  // aspect ratio 2
    EXPECT_NEAR((1.0f - view.y * scale / 6.5f) * 50.0f, y, 1e-3);
    EXPECT_EQ(ray.t_min, camera.near_m);
    EXPECT_EQ(ray.t_max, camera.far_m);
  }
}

TEST(CameraRays, AreParallelWhenOrthographic) {
  Camera camera;
  camera.orthographic = true;
  camera.ortho_half_height_m = 5.0f;
  const CameraRays rays(camera, 20, 10);
  const Ray corner = rays.through(0, 0).ray;
  EXPECT_EQ(corner.origin, glm::vec3(-10, 5, 0));
  EXPECT_EQ(corner.direction, glm::vec3(0, 0, -1));
}

TEST(TraceVisibility, SeesExactlyTheSamplesInsideAQuad) {
  const Scene scene = quad_scene(4.0f);
  const ReferenceScene reference(scene);
  const ReferenceOptions options = options_of(16, 16, 9);
  const std::vector<Visibility> seen = trace_visibility(reference, options);
  ASSERT_EQ(seen.size(), 16u * 16u * 9u);
  std::size_t at = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      for (const glm::vec2 offset : sample_offsets(options, x, y)) {
        const Visibility& hit = seen[at++];
        // Half the image is 8 pixels and 4 m; the quad reaches 1 m.
        const float wx = (static_cast<float>(x) + 0.5f + offset.x - 8.0f) / 2.0f;
        const float wy = (8.0f - static_cast<float>(y) - 0.5f - offset.y) / 2.0f;
        ASSERT_EQ(static_cast<bool>(hit), std::abs(wx) < 1.0f && std::abs(wy) < 1.0f) << x << " " << y;
        if (!hit) continue;
        EXPECT_NEAR(hit.t, 4.0f, 1e-5f);
        EXPECT_EQ(hit.instance, 0u);
        EXPECT_EQ(hit.primitive, wx > wy ? 0u : 1u);
        EXPECT_TRUE(hit.front_face);
      }
}

TEST(TraceVisibility, UsesTheGivenPositionsInTheirOrder) {
  const Scene scene = quad_scene(4.0f);
  const ReferenceScene reference(scene);
  ReferenceOptions options = options_of(16, 16, 1);
  options.offsets_px = {{-0.4f, 0.0f}, {0.4f, 0.0f}, {0.0f, 0.0f}};
  Scene moved_scene = scene;
  moved_scene.instances[0].world_from_local = moved(0.25f, 0, -4);  // by half a pixel
  const ReferenceScene shifted(moved_scene);
  const std::vector<Visibility> seen = trace_visibility(shifted, options);
  const std::size_t pixel = (8 * 16 + 6) * 3;  // its left half is free
  EXPECT_FALSE(seen[pixel]);
  EXPECT_TRUE(seen[pixel + 1]);
}

TEST(TraceVisibility, KeepsNearAndFarPlane) {
  Scene scene = quad_scene(4.0f);
  const auto hits = [&](float near_m, float far_m) {
    scene.cameras[0].near_m = near_m;
    scene.cameras[0].far_m = far_m;
    return static_cast<bool>(seen_in_the_middle(scene));
  };
  EXPECT_TRUE(hits(0.1f, 100.0f));
  EXPECT_TRUE(hits(3.9f, 4.1f));
  EXPECT_FALSE(hits(4.1f, 100.0f));
  EXPECT_FALSE(hits(0.1f, 3.9f));
}

TEST(TraceVisibility, CullsTheBackOfSingleSidedMaterialsOnly) {
  Scene scene = quad_scene(4.0f);
  scene.instances[0].world_from_local = moved(0, 0, -4) * scaled(-1, 1, -1);  // turned around
  EXPECT_FALSE(seen_in_the_middle(scene));
  scene.materials[0].double_sided = true;
  const ReferenceScene both(scene);
  const PixelRay pixel = CameraRays(scene.cameras[0], 1, 1).through(0.4, 0.4);
  const Visibility back = both.trace(pixel.ray);
  ASSERT_TRUE(back);
  EXPECT_FALSE(back.front_face);
  EXPECT_NEAR(both.surface(back, pixel).normal.z, 1.0f, 1e-6f);  // toward the viewer
}

TEST(TraceVisibility, TakesCounterClockwiseInTheMeshAsFrontInMirroredInstances) {
  Scene scene = quad_scene(4.0f);
  scene.instances[0].world_from_local = moved(0, 0, -4) * scaled(-1, 1, 1);
  const Visibility hit = seen_in_the_middle(scene);
  ASSERT_TRUE(hit);
  EXPECT_TRUE(hit.front_face);
}

TEST(TraceVisibility, LetsMaskedPointsPass) {
  Scene scene = quad_scene(4.0f);
  scene.materials[0].alpha_mode = AlphaMode::mask;
  const ReferenceScene half(scene, [](const AlphaQuery& q) { return q.uv0.x < 0.5f ? 0.49f : 0.5f; });
  const std::vector<Visibility> seen = trace_visibility(half, options_of(16, 16, 1));
  EXPECT_FALSE(seen[8 * 16 + 6]);
  EXPECT_TRUE(seen[8 * 16 + 9]);
  scene.materials[0].base_color.w = 0.4f;
  EXPECT_FALSE(seen_in_the_middle(scene));
}

TEST(TraceVisibility, FindsTheNearestOfACubeAndAPlane) {
  Scene scene = empty_scene();
  scene.meshes = {quad_mesh(0), cube_mesh(0)};
  scene.instances = {{0, moved(0, 0, -9) * scaled(20, 20, 1), "plane"}, {1, moved(0, 0, -5), "cube"}};
  const std::vector<Visibility> seen = trace_visibility(ReferenceScene(scene), options_of(64, 64, 1));
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const Visibility& hit = seen[static_cast<std::size_t>(y * 64 + x)];
      const auto offset = sample_offsets(options_of(64, 64, 1), x, y).front();
      const float wx = (static_cast<float>(x) + 0.5f + offset.x) / 32.0f - 1.0f;
      const float wy = (static_cast<float>(y) + 0.5f + offset.y) / 32.0f - 1.0f;
      const bool on_cube =
          std::max(std::abs(wx), std::abs(wy)) < 0.25f;  // its front face, 1 m high, is 4 m away
      ASSERT_EQ(hit.instance, on_cube ? 1u : 0u) << x << " " << y;
      EXPECT_NEAR(hit.t, on_cube ? 4.0f : 9.0f, 1e-4f);
      if (on_cube) {
        EXPECT_LT(hit.primitive, 2u);
        EXPECT_EQ(hit.part, 0u);
      }
    }
  scene.instances[1].world_from_local = moved(3.5f, 0, -5);  // the cube's left side shows: the second part
  const Visibility side =
      ReferenceScene(scene).trace(CameraRays(scene.cameras[0], 64, 64).through(32 + 32 * 0.55, 32.3).ray);
  EXPECT_EQ(side.part, 1u);
  EXPECT_GE(side.primitive, 4u);
  EXPECT_LT(side.primitive, 12u);
}

TEST(SurfaceHit, InterpolatesAttributesInWorldSpace) {
  Scene scene = quad_scene(4.0f);
  scene.instances[0].world_from_local = moved(0, 0, -4) * scaled(2, 1, 1);
  const ReferenceScene reference(scene);
  const PixelRay pixel = CameraRays(scene.cameras[0], 16, 16).through(11, 7);
  const Visibility hit = reference.trace(pixel.ray);
  ASSERT_TRUE(hit);
  const SurfaceHit s = reference.surface(hit, pixel);
  EXPECT_NEAR(glm::length(s.position - glm::vec3(1.5f, 0.5f, -4.0f)), 0.0f, 1e-5f);
  EXPECT_NEAR(glm::length(s.uv0 - glm::vec2(0.875f, 0.75f)), 0.0f, 1e-5f);
  EXPECT_NEAR(glm::length(s.uv1 - glm::vec2(3.0f, 1.75f)), 0.0f, 1e-5f);
  EXPECT_NEAR(glm::length(s.color - glm::vec4(0.875f, 0.75f, 0, 1)), 0.0f, 1e-5f);
  EXPECT_NEAR(glm::length(s.normal - glm::vec3(0, 0, 1)), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::length(s.tangent - glm::vec4(1, 0, 0, -1)), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::length(s.to_viewer - glm::normalize(-s.position)), 0.0f, 1e-6f);
  EXPECT_NEAR(s.view_distance_m, 4.0f, 1e-5f);
}

TEST(SurfaceHit, HasTheDerivativesThatNeighboringRaysShow) {
  Scene scene = quad_scene(4.0f);
  glm::mat4 tilted = moved(0.1f, -0.2f, -3.0f);
  tilted[0] = {0.8f, 0.1f, -0.5f, 0};
  tilted[1] = {0.0f, 0.9f, 0.4f, 0};
  for (const bool orthographic : {false, true}) {
    scene.instances[0].world_from_local = tilted;
    scene.cameras[0].orthographic = orthographic;
    const ReferenceScene reference(scene);
    const CameraRays rays(scene.cameras[0], 64, 64);
    const auto uv = [&](double x, double y) {
      const PixelRay pixel = rays.through(x, y);
      return reference.surface(reference.trace(pixel.ray), pixel);
    };
    const double h = 0.05;
    const SurfaceHit center = uv(30, 36);
    const auto near_slope = [&](glm::vec2 slope, glm::vec2 after, glm::vec2 before) {
      EXPECT_NEAR(glm::length(slope - (after - before) / static_cast<float>(2 * h)), 0.0f, 2e-4f)
          << orthographic;
      EXPECT_GT(glm::length(slope), 5e-3f);
    };
    near_slope(center.uv0_dx, uv(30 + h, 36).uv0, uv(30 - h, 36).uv0);
    near_slope(center.uv0_dy, uv(30, 36 + h).uv0, uv(30, 36 - h).uv0);
    near_slope(center.uv1_dx, uv(30 + h, 36).uv1, uv(30 - h, 36).uv1);
    near_slope(center.uv1_dy, uv(30, 36 + h).uv1, uv(30, 36 - h).uv1);
  }
}

TEST(ReferenceScene, CastsShadowsOfBothSidesButNotOfMaskedOrBlendedPoints) {
  Scene scene = quad_scene(4.0f);
  const glm::vec3 before(0.3f, 0.2f, -2), behind(0.3f, 0.2f, -6), beside(5, 0, -6), on(0.3f, 0.2f, -4);
  const auto sees = [&](glm::vec3 from, glm::vec3 to) { return ReferenceScene(scene).visible(from, to); };
  EXPECT_FALSE(sees(before, behind));
  EXPECT_FALSE(sees(behind, before));
  EXPECT_TRUE(sees(before, beside));
  EXPECT_TRUE(sees(on, before));  // no shadow on itself
  EXPECT_TRUE(sees(before, on));
  EXPECT_FALSE(ReferenceScene(scene).sees_sky(before, {0, 0, -0.01f}));
  EXPECT_TRUE(ReferenceScene(scene).sees_sky(before, {0, 0, 1}));
  scene.materials[0].alpha_mode = AlphaMode::blend;
  EXPECT_TRUE(sees(before, behind));
  scene.materials[0].alpha_mode = AlphaMode::mask;
  EXPECT_FALSE(sees(before, behind));
  scene.materials[0].base_color.w = 0.0f;
  EXPECT_TRUE(sees(before, behind));
}

TEST(ReferenceScene, SurvivesScenesWithNothingToSee) {
  Scene scene = empty_scene();
  EXPECT_FALSE(trace_visibility(ReferenceScene(scene), options_of(2, 2, 2)).front());
  scene.meshes.resize(1);  // no vertices, no parts
  scene.meshes.push_back(quad_mesh(0));
  scene.meshes[1].parts[0].index_count = 0;
  scene.meshes.push_back(quad_mesh(0));
  scene.instances = {{0, moved(0, 0, -4), ""}, {1, moved(0, 0, -4), ""}, {2, scaled(1, 1, 0), ""}};
  EXPECT_FALSE(trace_visibility(ReferenceScene(scene), options_of(2, 2, 2)).front());
  EXPECT_THROW(trace_visibility(ReferenceScene(scene), options_of(0, 2, 2)), std::invalid_argument);
}

TEST(SampleOffsets, FillThePixelEvenlyAndDifferFromPixelToPixel) {
  const ReferenceOptions options = options_of(8, 8, 64);
  int in_quadrants[4] = {0, 0, 0, 0};
  for (const glm::vec2 offset : sample_offsets(options, 3, 5)) {
    EXPECT_GE(std::min(offset.x, offset.y), -0.5f);
    EXPECT_LT(std::max(offset.x, offset.y), 0.5f);
    ++in_quadrants[(offset.x < 0 ? 0 : 1) + (offset.y < 0 ? 0 : 2)];
  }
  for (const int count : in_quadrants) EXPECT_NEAR(count, 16, 3);
  EXPECT_NE(sample_offsets(options, 3, 5)[0], sample_offsets(options, 5, 3)[0]);
}

TEST(RenderReference, AveragesCoverageOverABackground) {
  Scene scene = quad_scene(4.0f);
  scene.instances[0].world_from_local = moved(0.25f * 0.6f, 0, -4);  // the left edge at 30 % of pixel 6
  const Image image = render_reference(ReferenceScene(scene), options_of(16, 16, 400), shade_white);
  EXPECT_EQ(image.at(8, 8), glm::vec4(1.0f));
  EXPECT_EQ(image.at(1, 1), glm::vec4(0.25f, 0.5f, 0.75f, 1.0f));
  EXPECT_NEAR(image.at(6, 8).x, 0.7f + 0.3f * 0.25f, 0.01f);
  EXPECT_NEAR(image.at(10, 8).z, 0.3f + 0.7f * 0.75f, 0.01f);
}

TEST(RenderReference, ComposesBlendedSurfacesFrontToBack) {
  Scene scene = empty_scene();
  scene.materials.resize(3);
  scene.materials[0].alpha_mode = scene.materials[1].alpha_mode = AlphaMode::blend;
  scene.meshes = {quad_mesh(0), quad_mesh(1), quad_mesh(2)};
  scene.instances = {{1, moved(0, 0, -5) * scaled(9, 9, 1), ""}, {0, moved(0, 0, -4) * scaled(9, 9, 1), ""}};
  const ShadeBatch by_material = [](std::span<const SurfaceHit> hits, std::span<glm::vec4> colors) {
    for (std::size_t i = 0; i < hits.size(); ++i)
      colors[i] = hits[i].material == 0 ? glm::vec4(1, 0, 0, 0.5f) : glm::vec4(0, 1, 0, 0.5f);
  };
  const glm::vec4 open = render_reference(ReferenceScene(scene), options_of(2, 2, 4), by_material).at(0, 0);
  EXPECT_NEAR(glm::length(open - glm::vec4(0.5f + 0.0625f, 0.25f + 0.125f, 0.1875f, 1.0f)), 0.0f, 1e-5f);
  scene.instances.push_back(
      {2, moved(0, 0, -6) * scaled(9, 9, 1), ""});  // opaque, whatever its color's alpha says
  const glm::vec4 closed = render_reference(ReferenceScene(scene), options_of(2, 2, 4), by_material).at(0, 0);
  EXPECT_NEAR(glm::length(closed - glm::vec4(0.5f, 0.5f, 0.0f, 1.0f)), 0.0f, 1e-5f);
  EXPECT_EQ(trace_visibility(ReferenceScene(scene), options_of(2, 2, 1)).front().instance, 2u);
  EXPECT_EQ(trace_visibility(ReferenceScene(scene), options_of(2, 2, 1), true).front().instance, 1u);
}

TEST(RenderReference, ClampsSamplesBeforeItAveragesThem) {
  ReferenceOptions options = options_of(1, 1, 256);
  options.largest_sample_value = 1.0f;
  const ShadeBatch bright = [](std::span<const SurfaceHit>, std::span<glm::vec4> colors) {
    for (glm::vec4& color : colors) color = glm::vec4(100.0f);
  };
  Scene scene = quad_scene(2.0f);  // a quarter of the image
  scene.background = glm::vec3(0.0f);
  EXPECT_NEAR(render_reference(ReferenceScene(scene), options, bright).at(0, 0).x, 0.25f, 0.01f);
}

TEST(RenderReference, GivesTheSameBitsForAnyNumberOfJobsAndReportsProgress) {
  Scene scene = empty_scene();
  scene.meshes = {cube_mesh(0)};
  glm::mat4 turned = moved(0.3f, -0.1f, -4.0f);
  turned[0] = {0.8f, 0.0f, -0.6f, 0}, turned[2] = {0.6f, 0, 0.8f, 0};
  scene.instances = {{0, turned, "cube"}};
  ReferenceOptions options = options_of(67, 45, 5);
  const ShadeBatch shade = [](std::span<const SurfaceHit> hits, std::span<glm::vec4> colors) {
    for (std::size_t i = 0; i < hits.size(); ++i)
      colors[i] = glm::vec4(glm::abs(hits[i].normal) * hits[i].view_distance_m, 1);
  };
  std::vector<double> shares;
  options.progress = [&](double share) { shares.push_back(share); };
  const Image one = render_reference(ReferenceScene(scene, {}, 1), options, shade);
  ASSERT_EQ(shares.size(), 45u);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1.0);
  options.jobs = 3;
  const Image three = render_reference(ReferenceScene(scene, {}, 3), options, shade);
  EXPECT_EQ(one.pixels, three.pixels);
  options.progress = [](double) { throw std::runtime_error("stop"); };
  EXPECT_THROW(render_reference(ReferenceScene(scene), options, shade), std::runtime_error);
}

}  // namespace
}  // namespace hwsim::pipeline
