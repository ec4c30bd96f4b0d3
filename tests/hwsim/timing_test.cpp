// Closed forms: what a unit alone would need, reached by the engines.
#include "hwsim/engines/timing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hwsim/sample_gpu.h"

namespace hwsim::test {
namespace {

constexpr std::size_t kManyChunks = 2000;  // the fill of the pipeline is then below 0.1 % a unit

TEST(Fill, EveryFormatReachesTheSmallestOfRasterExportAndRopRate) {
  struct Case {
    Format format;
    double px_per_clk;  // min(raster 32, export, 40 ROPs x ratio)
  };
  const Case cases[] = {{Format::rgba8_unorm, 28}, {Format::rgba8_srgb, 20}, {Format::rgba16_float, 14},
                        {Format::r32_float, 24},   {Format::rg32_float, 12}, {Format::rgba32_float, 7}};
  for (const auto& [format, px_per_clk] : cases) {
    const double ideal_ns = 1024.0 * kManyChunks / px_per_clk;
    const FrameTiming t = time_one(fill_pass(format, false, 1024, kManyChunks), sample_gpu());
    EXPECT_NEAR(t.time_ns / ideal_ns, 1.0, 0.01) << info(format).name;
    EXPECT_EQ(t.passes[0].limiter, Unit::crop);
  }
}

TEST(Fill, BlendingTakesTheRelativeRateOfTheFormat) {
  const auto blended_over_plain = [](Format format) {
    return time_one(fill_pass(format, true, 1024, kManyChunks), sample_gpu()).time_ns /
           time_one(fill_pass(format, false, 1024, kManyChunks), sample_gpu()).time_ns;
  };
  EXPECT_NEAR(blended_over_plain(Format::rgba8_unorm), 1.0, 0.01);
  EXPECT_NEAR(blended_over_plain(Format::rgba16_float), 2.0, 0.02);
  EXPECT_NEAR(blended_over_plain(Format::rgba32_float), 4.0, 0.04);
}

TEST(Fill, TwoTargetsCostTheSumOfBoth) {
  PassWork pass = fill_pass(Format::rgba8_unorm, false, 1024, kManyChunks);
  pass.color_targets.push_back({Format::rgba16_float, 1, false});
  for (PassCounters& c : pass.chunks) c.crop.exported_fragments = c.crop.written_samples = 2048;
  const double ideal_ns = kManyChunks * (1024.0 / 28 + 1024.0 / 14);
  EXPECT_NEAR(time_one(pass, sample_gpu()).time_ns / ideal_ns, 1.0, 0.01);
}

PassWork msaa_fill(std::uint64_t px, std::uint64_t single) {
  PassWork pass = fill_pass(Format::rgba8_unorm, false, px, kManyChunks);
  pass.raster_samples = 4;
  pass.color_targets = {{Format::rgba8_unorm, 4, false}};
  for (PassCounters& c : pass.chunks) {
    c.raster.covered_samples = c.crop.written_samples = 4 * px;
    c.crop.single_color_fragments = single;
  }
  return pass;
}

TEST(Msaa, CompressiblePixelsCostPixelRateAndOthersTheirSamples) {
  GpuConfig gpu = sample_gpu();
  EXPECT_NEAR(time_one(msaa_fill(1024, 1024), gpu).time_ns / (kManyChunks * 1024.0 / 28), 1.0, 0.01);
  EXPECT_NEAR(time_one(msaa_fill(1024, 0), gpu).time_ns / (kManyChunks * 4096.0 / 40), 1.0, 0.01);
  EXPECT_NEAR(time_one(msaa_fill(1024, 512), gpu).time_ns / (kManyChunks * 2048.0 / 40), 1.0, 0.01);
  gpu.crop_compressible_at_pixel_rate = false;
  EXPECT_NEAR(time_one(msaa_fill(1024, 1024), gpu).time_ns / (kManyChunks * 4096.0 / 40), 1.0, 0.01);
}

TEST(Geometry, CulledTrianglesReachTheCullRate) {
  PassCounters c;
  c.stats.input_assembly_vertices = 3000;
  c.setup.in_primitives = c.setup.culled_backface_primitives = 1000;
  const FrameTiming t = time_one(repeated(PassKind::draw, c, kManyChunks), sample_gpu());
  EXPECT_NEAR(1000.0 * kManyChunks / t.time_ns, 3.5, 0.035);
  EXPECT_EQ(t.passes[0].limiter, Unit::setup);
}

TEST(Geometry, DrawnTrianglesReachTheDrawRate) {
  PassCounters c;
  c.setup.in_primitives = c.setup.out_primitives = 1000;
  const FrameTiming t = time_one(repeated(PassKind::draw, c, kManyChunks), sample_gpu());
  EXPECT_NEAR(1000.0 * kManyChunks / t.time_ns, 2.0, 0.02);
}

TEST(Geometry, PartialQuadsCostWholeQuads) {
  PassCounters c;
  c.raster.covered_samples = c.raster.fragments = c.raster.quads = c.raster.partial_quads = 1024;
  const FrameTiming t = time_one(repeated(PassKind::draw, c, kManyChunks), sample_gpu());
  EXPECT_NEAR(t.time_ns / (kManyChunks * 4096.0 / 32), 1.0, 0.01);
}

TEST(Depth, ZOnlyReachesSamplesTimesEfficiency) {
  GpuConfig gpu = sample_gpu();
  gpu.zrop_efficiency_ratio = 0.8;
  PassCounters c;
  c.raster.covered_samples = c.zrop.early_z_tested_samples = c.zrop.written_samples = 8192;
  PassWork pass = repeated(PassKind::draw, c, kManyChunks);
  pass.raster_samples = 8;
  EXPECT_NEAR(8192.0 * kManyChunks / time_one(pass, gpu).time_ns, 40 * 4 * 0.8, 1.3);
}

TEST(Depth, CoarseRejectionReachesItsPixelRate) {
  PassCounters c;
  c.hiz.tested_tiles = c.hiz.killed_tiles = 512;
  EXPECT_NEAR(
      512 * 64.0 * kManyChunks / time_one(repeated(PassKind::draw, c, kManyChunks), sample_gpu()).time_ns,
      512.0, 5.0);
}

TEST(Shader, IssuedOperationsOfTheSubgroupWidthRunOnTheFilledSlots) {
  GpuConfig gpu = sample_gpu();
  gpu.vliw_slots = 5;
  gpu.vliw_fill_slots = 3.4;
  gpu.subgroup_size = 64;
  gpu.shader_clock_ratio = 2.0;
  PassCounters c;
  c.shader.alu_issued_lane_ops_w32 = 1;
  c.shader.alu_issued_lane_ops_w64 = 100'000;
  const FrameTiming t = time_one(repeated(PassKind::full_screen, c, 10), gpu);
  EXPECT_NEAR(t.time_ns, 1e6 / (10 * 32 * 3.4 / 5 * 2.0), 1e-6);
  EXPECT_EQ(t.passes[0].limiter, Unit::shader);
}

TEST(Shader, VertexAndPixelWorkShareTheCoresAndTheStackSplitsThem) {
  PassCounters c;
  c.vs.alu_lane_ops = 32'000;
  c.shader.alu_issued_lane_ops_w32 = 96'000;
  const PassTiming t = time_one(repeated(PassKind::draw, c, kManyChunks), sample_gpu()).passes[0];
  EXPECT_NEAR(t.time_ns / (kManyChunks * 128'000.0 / 320), 1.0, 0.01);
  EXPECT_NEAR(t.stack_ns[static_cast<std::size_t>(Unit::vs)] / t.time_ns, 0.25, 0.01);
}

TEST(Shader, InterpolationAddsToThePipeThatRunsIt) {
  GpuConfig gpu = sample_gpu();
  PassCounters c;
  c.shader.alu_issued_lane_ops_w32 = 320;
  c.shader.interp_lane_ops = 160;
  EXPECT_NEAR(time_one(repeated(PassKind::full_screen, c, 64), gpu).time_ns, 64 * 2.0, 1e-9);
  gpu.interp_on_alu = true;
  EXPECT_NEAR(time_one(repeated(PassKind::full_screen, c, 64), gpu).time_ns, 64 * 3.0, 1e-9);
}

PassWork color_write_pass(double compulsory_ratio) {
  PassCounters c;
  c.mem.color_write_bytes = 25'600;
  PassWork pass = repeated(PassKind::draw, c, 100);
  pass.color_targets = {{Format::rgba8_unorm, 1, false}};
  set_reuse(pass, compulsory_ratio);
  return pass;
}

TEST(Dram, LimitedPassReachesPeakTimesEfficiency) {
  GpuConfig gpu = sample_gpu();
  gpu.dram_bandwidth_gb_s = 100.0;
  gpu.dram_efficiency_ratio = 0.8;
  gpu.dram_cpu_share_ratio = 0.25;
  const FrameTiming t = time_one(color_write_pass(1.0), gpu);
  EXPECT_NEAR(t.time_ns / (100 * 25'600 / 60.0), 1.0, 0.01);
  EXPECT_EQ(t.passes[0].limiter, Unit::dram);
  EXPECT_DOUBLE_EQ(t.dram_bytes.total_write(), 100 * 25'600.0);
}

TEST(Dram, MovesWhatTheCacheOfTheStreamLetsThrough) {
  // 17 doublings from 1 KiB to 128 MiB, each keeps 1 / 17 of the 0.8 that can be kept.
  const auto moved = [](GpuConfig gpu) {
    return time_one(color_write_pass(0.2), gpu).dram_bytes.total_write() / (100 * 25'600.0);
  };
  GpuConfig gpu = sample_gpu();
  gpu.l2_size_kib = 256.0;
  EXPECT_NEAR(moved(gpu), 1.0 - 0.8 * 8 / 17, 1e-6);
  gpu.llc_size_kib = 256.0;
  EXPECT_NEAR(moved(gpu), 1.0 - 0.8 * 9 / 17, 1e-6);
  gpu.llc_size_kib = 128.0;  // linear between the sizes
  EXPECT_NEAR(moved(gpu), 1.0 - 0.8 * 8.5 / 17, 1e-6);
  gpu.llc_size_kib = 0.0;
  gpu.rop_through_l2 = false;  // and where the ROPs have a cache of their own, that one counts
  gpu.crop_cache_kib = 4.0;
  EXPECT_NEAR(moved(gpu), 1.0 - 0.8 * 2 / 17, 1e-6);
  gpu.l2_size_kib = 4096.0 * 1024.0;
  EXPECT_NEAR(moved(gpu), 1.0 - 0.8 * 2 / 17, 1e-6);
}

TEST(Dram, CachesInTheRopsKeepColorFromL2) {
  GpuConfig gpu = sample_gpu();
  gpu.crop_cache_kib = 16.0;
  const FrameTiming t = time_one(color_write_pass(0.2), gpu);
  EXPECT_NEAR(t.passes[0].busy_ns[static_cast<std::size_t>(Unit::l2)],
              100 * 25'600.0 * (1.0 - 0.8 * 4 / 17) / gpu.l2_bytes_per_clk, 1e-3);
}

TEST(Dram, FirstReadOfAClearedTargetIsFree) {
  PassCounters c;
  c.mem.depth_read_bytes = c.mem.depth_write_bytes = 10 * 256;
  PassWork pass = repeated(PassKind::draw, c, 10);
  pass.depth_format = Format::d32_float;
  set_reuse(pass, 1.0);
  EXPECT_DOUBLE_EQ(time_one(pass, sample_gpu()).dram_bytes.total_read(), 25'600.0);
  pass.depth_cleared_before = true;
  EXPECT_DOUBLE_EQ(time_one(pass, sample_gpu()).dram_bytes.total_read(), 0.0);
  EXPECT_DOUBLE_EQ(time_one(pass, sample_gpu()).dram_bytes.total_write(), 25'600.0);
}

TEST(Dram, StreamsWithoutReuseDistancesMoveAllThatTheyAskFor) {
  PassCounters c;
  c.mem.color_read_bytes = 700;
  c.mem.constant_read_bytes = 300;
  EXPECT_DOUBLE_EQ(time_one(repeated(PassKind::resolve, c, 10), sample_gpu()).dram_bytes.total_read(),
                   10'000.0);
}

TEST(Clear, CostsTheTableWhereFastAndEverySampleOtherwise) {
  PassWork pass;
  pass.kind = PassKind::clear;
  pass.width_px = 800;
  pass.height_px = 80;
  pass.color_targets = {{Format::rgba8_unorm, 4, false}};
  pass.depth_format = Format::d32_float;
  pass.depth_samples = 4;
  pass.chunks.resize(1);
  GpuConfig gpu = sample_gpu();
  gpu.fast_clear_color_bytes_per_tile = 0.5;
  gpu.fast_clear_depth_bytes_per_tile = 4.0;
  EXPECT_DOUBLE_EQ(time_one(pass, gpu).dram_bytes.total_write(), 1000 * 4.5);
  gpu.fast_clear_color = gpu.fast_clear_depth = false;
  const FrameTiming slow = time_one(pass, gpu);
  EXPECT_DOUBLE_EQ(slow.dram_bytes.total_write(), 64'000 * 4 * 8.0);
  EXPECT_DOUBLE_EQ(slow.passes[0].busy_ns[static_cast<std::size_t>(Unit::zrop)], 256'000 / 160.0);
  EXPECT_DOUBLE_EQ(slow.passes[0].busy_ns[static_cast<std::size_t>(Unit::crop)], 256'000 / 40.0);
}

TEST(Overhead, IsPaidByTheFirstPassAndAfterBarriers) {
  GpuConfig gpu = sample_gpu();
  gpu.pass_overhead_us = 7.0;
  WorkTrace trace;
  trace.passes.assign(3, fill_pass(Format::rgba8_unorm, false, 1024, 10));
  trace.passes[2].barrier_before = true;
  const FrameTiming t = time_frame(trace, gpu, Engine::queue);
  EXPECT_DOUBLE_EQ(t.passes[0].overhead_ns, 7000.0);
  EXPECT_DOUBLE_EQ(t.passes[1].overhead_ns, 0.0);
  EXPECT_DOUBLE_EQ(t.passes[2].overhead_ns, 7000.0);
  EXPECT_EQ(t.passes[2].limiter, Unit::fe);
  EXPECT_NEAR(t.passes[0].time_ns, t.passes[1].time_ns + 7000.0, 1e-9);
}

TEST(Engines, DoublingTheLimitingRateHalvesTheTime) {
  for (const Engine engine : {Engine::roofline, Engine::queue}) {
    GpuConfig gpu = sample_gpu();
    PassCounters c;
    c.tex.bilinear_probes = 5000;
    const double before = time_one(repeated(PassKind::full_screen, c, 100), gpu, engine).time_ns;
    gpu.tex_bilinear_per_clk *= 2.0;
    EXPECT_NEAR(time_one(repeated(PassKind::full_screen, c, 100), gpu, engine).time_ns, before / 2.0,
                1e-9 * before);
  }
}

TEST(Engines, RooflineLiesBetweenTheLargestUnitAndTheirSum) {
  const PassTiming t = time_one(busy_pass(50), sample_gpu(), Engine::roofline).passes[0];
  EXPECT_GE(t.time_ns, *std::max_element(t.busy_ns.begin(), t.busy_ns.end()));
  EXPECT_LE(t.time_ns, std::accumulate(t.busy_ns.begin(), t.busy_ns.end(), 0.0));
}

TEST(Engines, InvariantsHoldAndBrokenOnesAreReported) {
  WorkTrace trace;
  trace.passes = {busy_pass(500), busy_pass(3), fill_pass(Format::rgba8_unorm, true, 100, 7), PassWork{}};
  GpuConfig gpu = sample_gpu();
  gpu.dram_bandwidth_gb_s = 20.0;
  for (const Engine engine : {Engine::roofline, Engine::queue}) {
    const FrameTiming good = time_frame(trace, gpu, engine);
    EXPECT_TRUE(check_timing(good, trace, gpu).empty());
    FrameTiming bad = good;
    bad.passes[0].stack_ns[2] += 0.01 * bad.passes[0].time_ns;
    EXPECT_EQ(check_timing(bad, trace, gpu).size(), 1u);
    bad = good;
    bad.passes[0].dram_bytes.read[1] *= 1000.0;  // over the peak, and no longer the frame's sum
    EXPECT_EQ(check_timing(bad, trace, gpu).size(), 2u);
    bad = good;
    bad.time_ns = std::nan("");
    EXPECT_EQ(check_timing(bad, trace, gpu).size(), 1u);
    bad = good;
    bad.passes.pop_back();
    EXPECT_FALSE(check_timing(bad, trace, gpu).empty());
  }
}

}  // namespace
}  // namespace hwsim::test
