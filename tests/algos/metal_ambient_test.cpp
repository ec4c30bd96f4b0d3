// Ambient light on metals, through every technique: what it shows by a closed form, and what it costs.
#include <gtest/gtest.h>

#include <string>

#include "algos/base/reference_frame.h"
#include "algos/frame_run.h"
#include "algos/sss_scenes.h"
#include "pipeline/shade/lighting.h"

namespace hwsim::test {
namespace {
using namespace pipeline;

constexpr glm::vec3 kBase{0.6f, 0.5f, 0.4f};
constexpr float kMetallic = 0.75f;

/// Rods of metal with thin highlights, some of them wires; what lights them does not matter.
algos::FrameRequest rods(bool metal_ambient) {
  Scene scene = sss::empty_scene();
  scene.ambient = glm::vec3(0.3f);
  scene.materials[0].base_color = glm::vec4(kBase, 1.0f);
  scene.materials[0].metallic = kMetallic;
  scene.materials[0].roughness = 0.1f;
  Mesh& mesh = scene.meshes.emplace_back();
  sss::add_cylinder(mesh, 0.0f, 0.3f, 24, 6);
  mesh.parts = {{0, static_cast<std::uint32_t>(mesh.indices.size()), 0}};
  mesh.radius.assign(mesh.positions.size(), 0.3f);
  mesh.tangents.assign(mesh.positions.size(), glm::vec4(1, 0, 0, 1));
  mesh.vertex_bytes = 24;
  mesh.bounds_min = glm::vec3(-3.0f, -0.3f, -0.3f);
  mesh.bounds_max = glm::vec3(3.0f, 0.3f, 0.3f);
  scene.instances.push_back({0, glm::mat4(1.0f), "rod"});
  algos::FrameRequest request;
  request.scene = share(std::move(scene));
  request.width_px = sss::kSssWidth;
  request.height_px = sss::kSssHeight;
  request.features = test_features();
  request.shadows = false;
  request.metal_ambient = metal_ambient;
  return request;
}

Emulation drawn(const std::string& technique, const algos::FrameRequest& request) {
  return emulate(algos::build_frame(algos::parse_technique(technique), request), request.features,
                 request.functional, {});
}

constexpr const char* kTechniques[] = {"none",
                                       "msaa4x",
                                       "deferred:layout=gb_lauritzen",
                                       "deferred:layout=gb_sbaa40",
                                       "deferred_simple_complex:layout=gb_agaa16",
                                       "deferred_simple_complex:lighting=compute",
                                       "sbaa_top",
                                       "sbaa_merge",
                                       "agaa",
                                       "agaa:ndf=sggx",
                                       "agaa:accumulate=atomics",
                                       "sss_gs:mode=or",
                                       "sss_cs:mode=or",
                                       "sss_ppll:mode=or",
                                       "wire_aa",
                                       "wire_aa:lighting=both"};

/// The largest change of a pixel, each channel clamped by hand as the frame was.
glm::vec3 largest_gain(const Image& with, const Image& without) {
  glm::vec3 most(0.0f);
  for (std::size_t i = 0; i < with.pixels.size(); ++i)
    most = glm::max(most, glm::vec3(with.pixels[i]) - glm::vec3(without.pixels[i]));
  return most;
}

TEST(MetalAmbient, AddsTheSpecularColorTimesAmbientLight) {
  const auto on = rods(true), off = rods(false);
  const glm::vec3 specular = kBase * kMetallic + glm::vec3(0.04f * (1.0f - kMetallic));
  const glm::vec3 want = specular * 0.3f;
  for (const char* technique : kTechniques) {
    const glm::vec3 gain = largest_gain(drawn(technique, on).color, drawn(technique, off).color);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(gain[c], want[c], 0.012f) << technique << ", channel " << c;
  }
  const glm::vec3 gain = largest_gain(algos::render_reference_frame(on, {.samples = 1}),
                                      algos::render_reference_frame(off, {.samples = 1}));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(gain[c], want[c], 1e-4f) << "reference, channel " << c;
}

std::uint64_t operations(const Emulation& e, std::string_view pass = "") {
  std::uint64_t sum = 0;
  for (const PassWork& p : e.trace.passes)
    if (pass.empty() || p.name == pass) sum += total(p).shader.alu_lane_ops;
  return sum;
}

// Sums that follow a product cost nothing of their own. G-buffers' marks, which go with extended shading, do,
// and AGAA's specular color, which holds the energy of its lobe.
TEST(MetalAmbient, CostsDeferredTechniquesTheirMarks) {
  const auto on = rods(true), off = rods(false);
  for (const std::string technique : kTechniques) {
    const std::uint64_t with = operations(drawn(technique, on)), without = operations(drawn(technique, off));
    const bool folds_energy = technique.starts_with("agaa") && technique.find("ndf=") == technique.npos;
    if (technique.starts_with("deferred") || technique.starts_with("sbaa") || folds_energy)
      EXPECT_GT(with, without) << technique;
    else
      EXPECT_EQ(with, without) << technique;
  }
}

// An unlit surface sums no lights, whichever program shades it.
TEST(UnlitSurfaces, CostLessThanLitOnes) {
  const auto lit = rods(true);
  auto unlit = lit;
  Scene scene = *lit.scene;
  scene.materials[0].model = ShadingModel::unlit;
  unlit.scene = share(std::move(scene));
  for (const char* technique : {"none", "wire_aa", "wire_aa:lighting=both"})
    EXPECT_LT(operations(drawn(technique, unlit)), operations(drawn(technique, lit))) << technique;
  for (const char* technique : {"sss_gs:mode=or,rho_min=0", "sss_cs:mode=or,rho_min=0", "sss_ppll:mode=or"})
    EXPECT_LT(operations(drawn(technique, unlit), "sample"), operations(drawn(technique, lit), "sample"))
        << technique;
}

TEST(MetalAmbient, ChangesNothingWithoutMetalOrAmbientLight) {
  auto plain = rods(true);
  Scene scene = *plain.scene;
  scene.materials[0].metallic = 0.0f;
  plain.scene = share(scene);
  EXPECT_FALSE(needs_extended_shading(*plain.scene));
  scene.materials[0].metallic = 1.0f;
  EXPECT_TRUE(needs_extended_shading(scene));
  scene.ambient = glm::vec3(0.0f);
  EXPECT_FALSE(needs_extended_shading(scene));
}

}  // namespace
}  // namespace hwsim::test
