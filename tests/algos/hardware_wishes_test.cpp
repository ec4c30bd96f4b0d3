// The papers' wishes for hardware, each as a switch: what it changes in passes, memory, work and bytes, and
// that the picture stays (docs/what_if.md#the-papers-hardware-wishes).
#include <gtest/gtest.h>

#include <cmath>

#include "algos/agaa/shaders/counters.h"
#include "algos/agaa_frames.h"
#include "algos/sss/shaders/counters.h"

namespace hwsim::test {
namespace {

constexpr int kWishWidth = 160, kWishHeight = 90;

struct Wished {
  pipeline::Emulation without, with;
};

algos::FrameRequest request(const std::string& scene, const GpuFeatures& features) {
  algos::FrameRequest r;
  r.scene = generated_scene(scene);
  r.width_px = kWishWidth;
  r.height_px = kWishHeight;
  r.shadow_map_px = 256;
  r.features = features;
  return r;
}

pipeline::Emulation shoot(const std::string& technique, const std::string& scene,
                          const GpuFeatures& features) {
  const auto graph = algos::build_frame(algos::parse_technique(technique), request(scene, features));
  return pipeline::emulate(graph, features, FunctionalConfig{}, {});
}

Wished compare(const std::string& technique, const std::string& scene, void (*grant)(GpuFeatures&),
               GpuFeatures features = test_features()) {
  Wished w;
  w.without = shoot(technique, scene, features);
  grant(features);
  w.with = shoot(technique, scene, features);
  return w;
}

std::string refusal(const std::string& technique, const std::string& scene, const GpuFeatures& features) {
  try {
    shoot(technique, scene, features);
  } catch (const InputError& error) {
    return error.diagnostics().front().code + ": " + error.diagnostics().front().message + "; " +
           error.diagnostics().front().help;
  }
  return "";
}

bool has_pass(const pipeline::Emulation& e, const std::string& name) {
  return std::any_of(e.trace.passes.begin(), e.trace.passes.end(),
                     [&](const PassWork& p) { return p.name == name; });
}
PassCounters of(const pipeline::Emulation& e, const std::string& pass) {
  return total(pass_named(e.trace, pass));
}

// AGAA 5.3: no multicast, so a fourth of the triangles set up, no merge, and one record of each aggregate.
TEST(Wishes, Native32xSavesLayersAndMerge) {
  const Wished w =
      compare("agaa:c=2,msaa=32", "grass:blades=2000", [](GpuFeatures& f) { f.native_msaa_max = 32; });
  EXPECT_TRUE(has_pass(w.without, "merge"));
  EXPECT_FALSE(has_pass(w.with, "merge"));
  for (const char* pass : {"visibility", "generate"}) {
    const PassCounters without = of(w.without, pass), with = of(w.with, pass);
    EXPECT_EQ(without.vs.output_scalars, with.vs.output_scalars);
    EXPECT_GT(without.setup.out_primitives, with.setup.out_primitives * 3);
    // The same samples, but for those of tiles that the coarse test spares.
    EXPECT_NEAR(static_cast<double>(without.raster.covered_samples) /
                    static_cast<double>(with.raster.covered_samples),
                1.0, 0.02);
    EXPECT_GT(without.ps.invocations, with.ps.invocations);
  }
  // 234 bytes a pixel against 324 and the merged records (agaa_test.cpp).
  EXPECT_LT(w.with.trace.allocated_memory_bytes, w.without.trace.allocated_memory_bytes);
  EXPECT_LT(largest_difference(w.with.color, w.without.color), 0.2f);
  const Wished m = compare("msaa32x", "grass:blades=2000", [](GpuFeatures& f) { f.native_msaa_max = 32; });
  EXPECT_TRUE(has_pass(m.without, "merge"));
  EXPECT_FALSE(has_pass(m.with, "merge"));
  EXPECT_GT(of(m.without, "forward").setup.out_primitives, of(m.with, "forward").setup.out_primitives * 3);
  EXPECT_EQ(m.without.color.width, m.with.color.width);
}

// AGAA 4.1: the definition reads 32 to 192 bytes of a tile that is held as planes, not 6 N bytes of each of
// its pixels.
TEST(Wishes, CompressedDepthReplacesSamplesByPlanes) {
  const auto scene = share(patches({{-5, 5, 0, {0.7f, 0.4f, 0.2f}}}));
  GpuFeatures features = test_features();
  const pipeline::Emulation by_samples = render({scene, "agaa:c=2,msaa=8,k=1", features});
  features.compressed_depth_read = true;
  const pipeline::Emulation by_planes = render({scene, "agaa:c=2,msaa=8,k=1", features});
  const PassCounters without = of(by_samples, "define"), with = of(by_planes, "define");
  constexpr std::uint64_t kPixels = kWidth * kHeight, kTiles = kPixels / 64;
  EXPECT_EQ(without.technique[algos::AgaaCounters::agaa_plane_path_pixels], 0u);
  EXPECT_EQ(without.mem.texture_read_bytes, kPixels * 6 * 8);
  EXPECT_EQ(with.technique[algos::AgaaCounters::agaa_plane_path_pixels], kPixels);
  // One plane: 12 bytes in a piece of 32. Two triangles of the rectangle: 24, and a bit for each sample.
  EXPECT_GE(with.mem.texture_read_bytes, kTiles * 32);
  EXPECT_LE(with.mem.texture_read_bytes, kTiles * 96);
  EXPECT_LT(with.shader.alu_lane_ops, without.shader.alu_lane_ops);
  EXPECT_EQ(largest_difference(by_planes.color, by_samples.color), 0.0f);
  EXPECT_EQ(of(by_planes, "visibility").zrop.written_samples,
            of(by_samples, "visibility").zrop.written_samples);
  EXPECT_NE(refusal("agaa:plane_path=on", "grass:blades=100", test_features())
                .find("gpu.features.compressed_depth_read"),
            std::string::npos);
}

// AGAA 5.3: depth and coverage above eight samples without as many colors.
TEST(Wishes, CoverageAboveTheColorSamples) {
  GpuFeatures none = test_features();
  none.coverage_samples_max = 0;
  EXPECT_NE(refusal("csaa:mode=16x", "grass:blades=100", none).find("gpu.features.coverage_samples_max"),
            std::string::npos);
  EXPECT_NE(refusal("eqaa", "grass:blades=100", none).find("gpu.features.coverage_samples_max"),
            std::string::npos);
  EXPECT_EQ(refusal("csaa:mode=8xq", "grass:blades=100", none), "") << "8xQ is multisampling";
  const pipeline::Emulation four = shoot("msaa4x", "grass:blades=2000", test_features());
  const pipeline::Emulation more = shoot("csaa:mode=16x", "grass:blades=2000", test_features());
  const auto pixels = static_cast<std::uint64_t>(kWishWidth * kWishHeight);
  EXPECT_EQ(more.trace.allocated_memory_bytes - four.trace.allocated_memory_bytes, 6 * pixels);
  EXPECT_EQ(largest_difference(shoot("csaa:mode=8xq", "grass:blades=2000", test_features()).color,
                               shoot("msaa8x", "grass:blades=2000", test_features()).color),
            0.0f);
}

// SSS 4.2: sums of floats need no fixed point: the same picture, sixteen bytes a pixel, but no wrap.
TEST(Wishes, FloatAtomicsKeepThePicture) {
  GpuFeatures integer = test_features();
  integer.float_atomics = false;
  const char* scene = "car_body:triangles=25000";
  const Wished w = compare(
      "sss_cs", scene, [](GpuFeatures& f) { f.float_atomics = true; }, integer);
  const PassCounters without = of(w.without, "sample"), with = of(w.with, "sample");
  EXPECT_GT(with.shader.atomic_lane_ops, 0u);
  EXPECT_EQ(with.shader.atomic_lane_ops, without.shader.atomic_lane_ops);
  EXPECT_LT(with.shader.alu_lane_ops, without.shader.alu_lane_ops) << "neither scale nor conversion";
  EXPECT_EQ(w.with.trace.allocated_memory_bytes, w.without.trace.allocated_memory_bytes);
  EXPECT_LE(largest_difference(w.with.color, w.without.color), 1.5f / 255.0f);
  EXPECT_NE(refusal("sss_cs:atomics=float", scene, integer).find("gpu.features.float_atomics"),
            std::string::npos);
}

// SSS 4.1: points that the tessellator makes fill no buffer behind a geometry shader.
TEST(Wishes, TessellatorPointsFillNoBuffer) {
  const char* scene = "car_body:triangles=25000";
  const Wished w = compare("sss_gs", scene, [](GpuFeatures& f) { f.tessellator_points = true; });
  const PassCounters without = of(w.without, "sample"), with = of(w.with, "sample");
  EXPECT_GT(without.gs.output_bytes, 0u);
  EXPECT_EQ(with.gs.output_bytes, 0u);
  EXPECT_EQ(with.gs.output_vertices, without.gs.output_vertices);
  EXPECT_EQ(with.technique[algos::SssCounters::sss_point_samples],
            without.technique[algos::SssCounters::sss_point_samples]);
  EXPECT_EQ(largest_difference(w.with.color, w.without.color), 0.0f);
  EXPECT_NE(
      refusal("sss_gs:points=tessellator", scene, test_features()).find("gpu.features.tessellator_points"),
      std::string::npos);
}

// SSS 4.3.1: the rasterizer finds touched pixels itself, with fewer fragments than boxes have.
TEST(Wishes, ConservativeRasterSparesFragments) {
  const char* scene = "car_body:triangles=25000";
  const PassCounters boxes = of(shoot("sss_ppll", scene, test_features()), "sample");
  const PassCounters own = of(shoot("sss_ppll:conservative=raster", scene, test_features()), "sample");
  EXPECT_LT(own.raster.fragments, boxes.raster.fragments);
  EXPECT_LT(own.gs.output_bytes, boxes.gs.output_bytes);
  EXPECT_EQ(own.technique[algos::SssCounters::sss_stored_fragments],
            boxes.technique[algos::SssCounters::sss_stored_fragments]);
}

// AGAA 4: without mixed samples aggregates add up in a buffer, by atomics instead of blending.
TEST(Wishes, MixedSamplesReplaceAtomics) {
  GpuFeatures none = test_features();
  none.target_independent_raster = false;
  const Wished w = compare(
      "agaa:c=2,msaa=8", "grass:blades=2000", [](GpuFeatures& f) { f.target_independent_raster = true; },
      none);
  EXPECT_GT(of(w.without, "generate").shader.atomic_lane_ops, 0u);
  EXPECT_EQ(of(w.with, "generate").shader.atomic_lane_ops, 0u);
  EXPECT_EQ(of(w.without, "generate").crop.blended_samples, 0u);
  EXPECT_GT(of(w.with, "generate").crop.blended_samples, 0u);
  EXPECT_EQ(of(w.with, "generate").ps.invocations, of(w.without, "generate").ps.invocations);
  EXPECT_LT(w.with.trace.allocated_memory_bytes, w.without.trace.allocated_memory_bytes);
}

}  // namespace
}  // namespace hwsim::test
