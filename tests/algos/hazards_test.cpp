// Numerical hazards of the techniques, each provoked (the traps of docs/techniques/): what they do to a
// number is bounded, and nothing that is none reaches the image. Others have their place beside their
// technique: coplanar duplicates (agaa_test, sbaa_test), full lists (sss_test), wires at the eye
// (wire_test), exp2 and log2 at extremes (codec_test).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "algos/agaa_frames.h"
#include "algos/sbaa/shaders/counters.h"
#include "algos/sss/shaders/counters.h"

namespace hwsim::test {
namespace {
using pipeline::BlendFactor;
using pipeline::BlendState;

void expect_numbers(const pipeline::Image& image, const std::string& what) {
  for (const glm::vec4& p : image.pixels)
    for (int c = 0; c < 4; ++c)
      ASSERT_TRUE(std::isfinite(p[c]) && p[c] >= 0.0f && p[c] <= 1.0f) << what << ": " << p[c];
}

// Half of each pixel in the middle column has the normal n, half -n: the mean vanishes.
TEST(Hazards, OpposedNormalsHaveAMean) {
  pipeline::Scene scene = patches({{-5, 0.0f, 0, {0.8f, 0.8f, 0.8f}}, {0.0f, 5, 0, {0.8f, 0.8f, 0.8f}}});
  for (glm::vec3& n : scene.meshes[0].normals) n = {0.6f, 0.0f, 0.8f};
  for (glm::vec3& n : scene.meshes[1].normals) n = {-0.6f, 0.0f, -0.8f};
  const auto shared = share(std::move(scene));
  for (const char* options : {"", ",ndf=lean", ",ndf=sggx", ",brdf=ggx", ",diffuse_filter=geometric",
                              ",accumulate=atomics", ",agg_float=on", ",light_variance=on"})
    expect_numbers(render({shared, "agaa:c=1" + std::string(options), test_features(), 49, 32}).color,
                   options);
}

// Pixels without a sample have no mask to divide by: the background, to the bit.
TEST(Hazards, EmptyMasksAreBackground) {
  pipeline::Scene scene = patches({{-0.1f, 0.1f, 0}});
  scene.background = {0.2f, 0.4f, 0.6f};
  const auto shared = share(std::move(scene));
  const pipeline::Image expected = render({shared, "none"}).color;
  for (const char* technique :
       {"agaa:c=1", "agaa:c=4", "agaa:msaa=32", "agaa:ndf=sggx", "agaa:ndf=lean", "agaa:accumulate=atomics",
        "sbaa_top", "sbaa_merge", "sbaa_top:background=ignore"}) {
    const pipeline::Image found = render({shared, technique}).color;
    for (const int x : {0, 1, kWidth - 1}) EXPECT_EQ(found.at(x, 5), expected.at(x, 5)) << technique;
    expect_numbers(found, technique);
  }
}

// Two bytes of angles: half a step of 90/255 degrees, and of 360/256 around, up to the horizon.
TEST(Hazards, NormalCodesHoldAtGrazingAngles) {
  double worst_tilt = 0.0;
  int grazing = 0;
  for (const float slope : {0.0f, 0.5f, -2.0f, 8.0f, 25.0f, -28.0f}) {
    // A plane through (0, 0, 0) that rises toward the eye, which is at z = 2.
    const float half = std::min(5.0f, 1.2f / std::max(std::fabs(slope), 0.01f));
    const Shot run{share(patches({{-half, half, -slope * half, {0.5f, 0.5f, 0.5f}, slope}})), "agaa"};
    const Planes normal = planes_of(run, "normal"), depth = planes_of(run, "depth");
    const glm::vec3 n = glm::normalize(glm::vec3(-slope, 0, 1));
    const pipeline::Camera& camera = run.scene->cameras[0];
    const float tan_half = std::tan(0.5f * camera.fov_y_rad);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (depth.at(x, y, 0).x >= 1.0f) continue;
        const glm::vec3 to_eye = -glm::normalize(
            glm::vec3((2.0f * (static_cast<float>(x) + 0.5f) / kWidth - 1.0f) * tan_half * kWidth / kHeight,
                      (1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / kHeight) * tan_half, -1.0f));
        const glm::vec3 side = glm::normalize(glm::cross(glm::vec3(0, 1, 0), to_eye)),
                        up = glm::cross(to_eye, side);
        const float theta = normal.at(x, y, 0).x * 1.5707963f,
                    phi = normal.at(x, y, 0).y * (255.0f / 256.0f) * 6.2831853f;
        const glm::vec3 decoded =
            std::sin(theta) * (std::cos(phi) * side + std::sin(phi) * up) + std::cos(theta) * to_eye;
        const double degrees = 57.29578 * std::acos(std::min(1.0f, std::fabs(glm::dot(decoded, n))));
        worst_tilt = std::max(worst_tilt, degrees);
        grazing += glm::dot(n, to_eye) < 0.1f && glm::dot(n, to_eye) > -0.1f ? 1 : 0;
      }
  }
  EXPECT_GT(grazing, 50) << "pixels within 6 degrees of the horizon";
  EXPECT_LT(worst_tilt, 0.95) << "0.18 and 0.70 degrees, and the rounding of attributes";
  EXPECT_GT(worst_tilt, 0.3) << "the bound is near";
  std::printf("[     note ] normal codes: %.2f degrees, %d grazing pixels\n", worst_tilt, grazing);
}

// 32 fragments of 1/32 each: every addition rounds, by up to half a step of the format.
TEST(Hazards, ThirtyTwoAdditionsRoundByHalfAStepEach) {
  const std::vector<glm::vec3> cover = {{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}};
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;
  for (int i = 0; i < 32; ++i)
    for (const glm::vec3& p : cover) {
      indices.push_back(static_cast<std::uint32_t>(positions.size()));
      positions.push_back(p);
    }
  const auto scene = share(clip_space_scene(positions, indices));
  const auto worst_of = [&](Format format) {
    double worst = 0.0;
    for (int i = 1; i <= 40; ++i) {
      const float value = static_cast<float>(i) / 40.0f;
      SampleFrame frame(scene, 8, 8, 1, format);
      pipeline::DrawBatch batch = frame.all_draws(pipeline::mesh_position_program(), &constant_program());
      batch.fragment_uniforms = std::make_shared<glm::vec4>(value / 32.0f);
      batch.state.blend = {
          {true, BlendFactor::one, BlendFactor::one, BlendFactor::one, BlendFactor::one, 0xf}};
      frame.draw("add", {batch});
      worst = std::max(worst, std::fabs(static_cast<double>(frame.run().color.pixels[0].x) - value));
    }
    return worst;
  };
  const double unorm8 = worst_of(Format::rgba8_unorm), unorm10 = worst_of(Format::rgb10a2_unorm),
               snorm16 = worst_of(Format::rgba16_snorm), half = worst_of(Format::rgba16_float);
  std::printf("[     note ] 32 additions: unorm8 %.4f, unorm10 %.4f, snorm16 %.5f, half %.5f\n", unorm8,
              unorm10, snorm16, half);
  EXPECT_LE(unorm8, 32 * 0.5 / 255 + 1e-6);     // 6.3 %
  EXPECT_LE(unorm10, 32 * 0.5 / 1023 + 1e-6);   // 1.6 %
  EXPECT_LE(snorm16, 32 * 0.5 / 32767 + 1e-6);  // 0.05 %
  EXPECT_LE(half, 32 * 0x1p-12 + 1e-6);
  EXPECT_GT(unorm8, 0.02) << "the hazard is real";
  EXPECT_GT(unorm10, 0.005);
}

/// Coincident small triangles with normals far enough apart to be critical, each seen from the front.
std::shared_ptr<const pipeline::Scene> stacked_triangles(int count) {
  pipeline::Scene scene = patches({{-5, 5, -0.5f}});
  pipeline::Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const float side = 0.06f;
    // One by one: at -O3 GCC 12 draws a false warning (stringop-overflow) from inserted lists.
    for (const glm::vec3 corner : {glm::vec3(-side, -side, 0), {side, -side, 0}, {-side, side, 0}})
      mesh.positions.push_back(corner);
    for (const glm::vec3 normal : {glm::vec3(-0.4f, -0.4f, 1), {0.6f, -0.1f, 1}, {-0.1f, 0.6f, 1}})
      mesh.normals.push_back(glm::normalize(normal));
    for (std::uint32_t corner = 0; corner < 3; ++corner) mesh.indices.push_back(first + corner);
  }
  mesh.parts = {{0, static_cast<std::uint32_t>(mesh.indices.size()), 1}};
  mesh.vertex_bytes = 24;
  mesh.bounds_min = {-0.1f, -0.1f, 0};
  mesh.bounds_max = {0.1f, 0.1f, 0};
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({1, glm::mat4(1.0f), "stack"});
  pipeline::Material shiny;
  shiny.base_color = {0.9f, 0.9f, 0.9f, 1.0f};
  shiny.metallic = 1.0f;
  shiny.roughness = 0.3f;
  scene.materials.push_back(shiny);
  return share(std::move(scene));
}

// 24 bits behind the point leave room for sums of 256: more triangles in a pixel wrap around. The image
// stays one of numbers, and sums of floats stay right.
TEST(Hazards, IntegerAtomicsWrapAndStayNumbers) {
  GpuFeatures features = test_features();
  const auto shoot = [&](int count, const std::string& options) {
    return render({stacked_triangles(count), "sss_cs:mode=or,early_exit=off,tri_px=100,theta_c=1," + options,
                   features});
  };
  const pipeline::Emulation one = shoot(1, "atomics=integer,fixed_bits=24");
  ASSERT_GT(total(one.trace).technique[algos::SssCounters::sss_processed_primitives], 0u);
  const pipeline::Emulation wraps = shoot(600, "atomics=integer,fixed_bits=24");
  const pipeline::Emulation floats = shoot(600, "atomics=float");
  expect_numbers(wraps.color, "wrapped");
  expect_numbers(floats.color, "floats");
  const pipeline::Emulation room = shoot(600, "atomics=integer,fixed_bits=20");
  const float wrapped = largest_difference(wraps.color, room.color);
  const float kept = largest_difference(floats.color, room.color);
  std::printf("[     note ] 600 triangles: 24 bits differ by %.3f, floats by %.4f\n", wrapped, kept);
  EXPECT_LT(kept, 2.5f / 255.0f);
  EXPECT_GT(wrapped, 4.0f * kept) << "the hazard is real";
}

// One normal without any roughness: no covariance to invert, and no volume.
TEST(Hazards, SingularLobesAreWidened) {
  pipeline::Scene scene =
      patches({{-5, 0.02f, 0, {0.9f, 0.9f, 0.9f}}, {0.02f, 5, -0.3f, {0.9f, 0.9f, 0.9f}, 0.3f}});
  for (pipeline::Material& m : scene.materials) {
    m.roughness = 0.0f;
    m.metallic = 1.0f;
  }
  const auto shared = share(std::move(scene));
  for (const char* options : {"ndf=lean", "ndf=sggx", "ndf=sggx,brdf=ggx", "ndf=lean,agg_float=on",
                              "brdf=ggx", "ndf=sggx,accumulate=atomics", "s_ref=0", "gloss=separate"})
    expect_numbers(render({shared, "agaa:" + std::string(options)}).color, options);
}

/// The share of pixels of one tilted triangle that MERGE takes for two groups of depths.
double fallback_share(int samples) {
  std::mt19937 random(5);
  const auto next = [&] { return static_cast<float>(random() % 2001) / 1000.0f - 1.0f; };
  std::uint64_t fallbacks = 0, pixels = 0;
  for (int i = 0; i < 60; ++i) {
    const float angle = 3.14159265f * next();
    pipeline::Scene scene = patches({{-1, 1, 0}});
    // A screen-filling rectangle, tilted: depths rise along a direction of any angle.
    const float dx = 0.25f * std::cos(angle), dy = 0.25f * std::sin(angle);
    scene.meshes[0].positions = {
        {-9, -9, -9 * (dx + dy)}, {27, -9, 27 * dx - 9 * dy}, {-9, 27, -9 * dx + 27 * dy}};
    for (glm::vec3& p : scene.meshes[0].positions) p.z -= 12.0f;
    scene.meshes[0].normals.assign(3, glm::normalize(glm::vec3(-dx, -dy, 1)));
    scene.meshes[0].indices = {0, 1, 2};
    scene.meshes[0].parts = {{0, 3, 0}};
    scene.meshes[0].bounds_min = glm::vec3(-30);
    scene.meshes[0].bounds_max = glm::vec3(30);
    const pipeline::Emulation e = render(
        {share(std::move(scene)), "sbaa_merge:n=2,msaa=" + std::to_string(samples), test_features(), 16, 16});
    const TechniqueCounters n = total(e.trace).technique;
    fallbacks += n[algos::SbaaCounters::merge_fallbacks_surfaces];
    pixels += n[algos::SbaaCounters::slots_emitted_first_surfaces];
  }
  return static_cast<double>(fallbacks) / static_cast<double>(pixels);
}

// docs/techniques/sbaa.md#analysis: a tilted plane at 4 samples is taken for two groups in 41 % of
// orientations, at 8 never.
TEST(Hazards, FourSamplesOfAPlaneMayLookBimodal) {
  const double four = fallback_share(4), eight = fallback_share(8);
  std::printf("[     note ] planes taken for two groups: 4 samples %.2f, 8 samples %.2f\n", four, eight);
  EXPECT_NEAR(four, 0.41, 0.12);
  EXPECT_LT(eight, 0.01) << "but for the rounding of stored depths";
}

// Samples whose depth rounds to the far plane's are sky: no aggregate, nothing to unproject to infinity.
TEST(Hazards, SamplesAtTheFarPlaneAreSky) {
  pipeline::Scene scene = patches({{-200, 200, -90}, {-0.4f, 0.3f, 0}});
  scene.cameras[0].near_m = 0.001f;
  scene.cameras[0].far_m = 95.0f;
  for (glm::vec3& p : scene.meshes[0].positions) p.y *= 100.0f;
  scene.meshes[0].bounds_min.y *= 100.0f;
  scene.meshes[0].bounds_max.y *= 100.0f;
  const auto shared = share(std::move(scene));
  for (const char* technique : {"agaa", "agaa:c=4,k_mode=footprint", "agaa:msaa=32", "agaa:ndf=sggx",
                                "sbaa_merge", "deferred_simple_complex:samples=8", "agaa:accumulate=atomics"})
    expect_numbers(render({shared, technique}).color, technique);
}

// Nothing at all, and a light that looks away: exponents and logarithms of zero.
TEST(Hazards, DarkAndEmptyFramesAreNumbers) {
  pipeline::Scene dark = patches({{-5, 5, 0, {0.0f, 0.0f, 0.0f}}});
  dark.lights[0].direction = {0, 0, 1};
  dark.materials[0].roughness = 0.0f;
  dark.materials[0].metallic = 1.0f;
  pipeline::Scene empty = patches({{-5, 5, 0}});
  empty.instances.clear();
  const auto dark_scene = share(std::move(dark)), empty_scene = share(std::move(empty));
  for (const algos::TechniqueInfo& t : algos::techniques()) {
    const std::string id(t.id);
    if (id == "ssaa64x") continue;  // as ssaa16x
    expect_numbers(render({dark_scene, id}).color, id);
    expect_numbers(render({empty_scene, id}).color, id);
  }
}

}  // namespace
}  // namespace hwsim::test
