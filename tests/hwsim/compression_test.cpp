// Bytes of compressed depth and color, and of tile memory: closed forms that every engine meets.
#include "hwsim/timing/compression.h"

#include <gtest/gtest.h>

#include <numeric>

#include "hwsim/gpu/gpu_rates.h"
#include "hwsim/sample_gpu.h"
#include "hwsim/timing/traffic.h"

namespace hwsim::test {
namespace {

constexpr std::size_t kColor = static_cast<std::size_t>(Stream::color);
constexpr std::size_t kDepth = static_cast<std::size_t>(Stream::depth);
constexpr std::size_t kOther = static_cast<std::size_t>(Stream::other);
constexpr std::uint64_t kTiles = 100;
constexpr std::size_t kChunks = 10;

GpuConfig compressing_gpu() {
  GpuConfig gpu = sample_gpu();
  gpu.depth_offset_forms = true;
  return gpu;
}

TEST(DepthTile, BytesAreThoseOfTheSpecification) {
  const GpuRates<double> r = derive_rates<double>(compressing_gpu());
  EXPECT_EQ(depth_tile_bytes(1, 256.0, r), (DepthMix{0, 32, 32, 64, 64, 128, 256}));
  EXPECT_EQ(depth_tile_bytes(8, 2048.0, r), (DepthMix{0, 32, 96, 192, 480, 992, 2048}));
  EXPECT_EQ(depth_tile_bytes(32, 8192.0, r)[2], 288.0);
  EXPECT_EQ(depth_tile_bytes(32, 8192.0, r)[3], 576.0);
}

TEST(DepthTile, FormsThatAGpuLacksAreRaw) {
  GpuConfig gpu = sample_gpu();
  gpu.depth_plane_slots = 2;
  gpu.compression_granule_bytes = 16;
  gpu.fast_clear_depth = false;
  const DepthMix two = depth_tile_bytes(1, 256.0, derive_rates<double>(gpu));
  EXPECT_EQ(two, (DepthMix{256, 16, 32, 256, 256, 256, 256}));
  gpu.depth_plane_slots = 0;
  EXPECT_EQ(depth_tile_bytes(1, 256.0, derive_rates<double>(gpu))[1], 256.0);
}

/// Each of `kTiles` tiles is read and written once a chunk, whole; no cache keeps any.
PassWork depth_pass(int samples) {
  const auto raw = static_cast<std::uint64_t>(256 * samples);
  PassCounters c;
  c.mem.depth_read_bytes = c.mem.depth_write_bytes = kTiles * raw;
  c.zrop.read_one_plane_tiles = c.zrop.write_two_plane_tiles = kTiles;
  PassWork pass = repeated(PassKind::draw, c, kChunks);
  pass.depth_format = Format::d32_float;
  pass.depth_samples = samples;
  MissCurve curve;
  curve.requested_read_bytes = curve.requested_write_bytes = kChunks * kTiles * raw;
  curve.read_bytes.fill(curve.requested_read_bytes);
  curve.write_bytes.fill(curve.requested_write_bytes);
  curve.read_stays.fill(kChunks * kTiles);
  curve.write_stays.fill(kChunks * kTiles);
  pass.reuse.apart[index_of(ReuseStream::depth)] = pass.reuse.shared[index_of(ReuseStream::depth)] = curve;
  return pass;
}

TEST(DepthTraffic, IsTheBytesOfTheCountedFormsInEveryEngine) {
  GpuConfig gpu = sample_gpu();
  gpu.l2_size_kib = 16.0;  // the event-driven engine's L2 is too small to keep a tile
  for (const int samples : {1, 8}) {
    const double two_planes = samples == 1 ? 32.0 : 96.0, stays = kChunks * kTiles;
    for (const Engine engine : {Engine::roofline, Engine::queue, Engine::detailed}) {
      const FrameTiming t = time_one(depth_pass(samples), gpu, engine);
      const double tolerance = engine == Engine::detailed ? 0.03 : 1e-9;
      EXPECT_NEAR(t.dram_bytes.read[kDepth] / (stays * 32.0), 1.0, tolerance) << engine_name(engine);
      EXPECT_NEAR(t.dram_bytes.write[kDepth] / (stays * two_planes), 1.0, tolerance) << engine_name(engine);
    }
  }
}

TEST(DepthTraffic, GrowsInBytesAndTimeWithoutCompression) {
  GpuConfig gpu = sample_gpu();
  gpu.dram_bandwidth_gb_s = 10.0;
  gpu.dram_turn_ns = 0.0;
  const PassWork pass = depth_pass(4);
  const FrameTiming with = time_one(pass, gpu);
  gpu.depth_plane_slots = 0;
  const FrameTiming without = time_one(pass, gpu);
  EXPECT_DOUBLE_EQ(with.dram_bytes.total_read(), 32.0 * kTiles * kChunks);
  EXPECT_DOUBLE_EQ(without.dram_bytes.total_read(), 1024.0 * kTiles * kChunks);
  EXPECT_NEAR(without.time_ns / with.time_ns, 2048.0 / (32.0 + 64.0), 0.01);  // DRAM limits both
}

TEST(DepthTraffic, AStayNeverMovesMoreThanItAskedFor) {
  PassWork pass = depth_pass(1);
  for (PassCounters& c : pass.chunks) c.mem.depth_read_bytes = kTiles * 8;  // two samples a tile
  for (auto* profile : {&pass.reuse.apart, &pass.reuse.shared}) {
    MissCurve& curve = (*profile)[index_of(ReuseStream::depth)];
    curve.requested_read_bytes = kTiles * kChunks * 8;
    curve.read_bytes.fill(curve.requested_read_bytes);
  }
  EXPECT_DOUBLE_EQ(time_one(pass, sample_gpu()).dram_bytes.total_read(), 8.0 * kTiles * kChunks);
}

TEST(DepthTraffic, TilesStillClearedAreTakenOutOfTheMixWhereTheirFirstReadIsFree) {
  PassWork pass = depth_pass(1);
  for (PassCounters& c : pass.chunks) c.zrop.read_clear_tiles = kTiles;
  EXPECT_DOUBLE_EQ(time_one(pass, sample_gpu()).dram_bytes.read[kDepth], 16.0 * kTiles * kChunks);
  for (auto* profile : {&pass.reuse.apart, &pass.reuse.shared})
    (*profile)[index_of(ReuseStream::depth)].first_read_bytes.fill(kTiles * 256 * kChunks / 2);
  pass.depth_cleared_before = true;  // half of the bytes are first reads, the other half are planes
  EXPECT_DOUBLE_EQ(time_one(pass, sample_gpu()).dram_bytes.read[kDepth], 16.0 * kTiles * kChunks);
}

/// 6400 pixels a chunk, a quarter of them with two colors, one in sixteen with more.
PassWork color_pass(int samples) {
  PassCounters c;
  c.mem.color_write_bytes = 6400 * 4 * static_cast<std::uint64_t>(samples);
  c.crop.write_single_pixels = 4400;
  c.crop.write_double_pixels = 1600;
  c.crop.write_mixed_pixels = 400;
  c.crop.write_single_groups_8px = 400;   // 3200 pixels
  c.crop.write_single_groups_16px = 100;  // 1600 pixels
  PassWork pass = repeated(PassKind::draw, c, kChunks);
  pass.color_targets = {{Format::rgba8_unorm, samples, false}};
  return pass;
}

double color_ratio(const PassWork& pass, const GpuConfig& gpu) {
  return time_one(pass, gpu).dram_bytes.write[kColor] /
         static_cast<double>(total(pass).mem.color_write_bytes);
}

TEST(ColorTraffic, FragmentMasksStoreEachColorOfAPixelOnce) {
  GpuConfig gpu = sample_gpu();
  const double single = 4400.0 / 6400, twice = 1600.0 / 6400, mixed = 400.0 / 6400;
  EXPECT_DOUBLE_EQ(color_ratio(color_pass(4), gpu), (single + 2 * twice) / 4 + mixed + 1.0 / 16);
  EXPECT_DOUBLE_EQ(color_ratio(color_pass(8), gpu), (single + 2 * twice) / 8 + mixed + 4.0 / 32);
  gpu.msaa_color_compression = false;
  EXPECT_DOUBLE_EQ(color_ratio(color_pass(4), gpu), 1.0);
}

TEST(ColorTraffic, BlocksCompressWhereAllTheirPixelsHaveOneColor) {
  GpuConfig gpu = sample_gpu();
  gpu.msaa_color_block_bytes = 256;
  EXPECT_DOUBLE_EQ(color_ratio(color_pass(8), gpu), 0.5 / 8 + 0.5);    // blocks of 8 pixels
  EXPECT_DOUBLE_EQ(color_ratio(color_pass(4), gpu), 0.25 / 4 + 0.75);  // blocks of 16 pixels
  PassWork wide = color_pass(8);
  wide.color_targets[0].format = Format::rgba16_float;  // blocks of 4: between single pixels and groups of 8
  const double in_4px = 4400.0 / 6400 + (0.5 - 4400.0 / 6400) * 2.0 / 3.0;
  EXPECT_DOUBLE_EQ(color_ratio(wide, gpu), in_4px / 8 + 1.0 - in_4px);
}

TEST(ColorTraffic, DeltaCompressionIsARatioOfSingleSampleColor) {
  GpuConfig gpu = sample_gpu();
  gpu.color_delta_ratio = 0.75;
  EXPECT_DOUBLE_EQ(color_ratio(color_pass(1), gpu), 0.75);
  gpu.msaa_color_compression = false;
  EXPECT_DOUBLE_EQ(color_ratio(color_pass(4), gpu), 1.0);
  PassWork two = color_pass(4);
  two.color_targets.push_back({Format::rgba8_unorm, 1, false});  // a fifth of the bytes
  EXPECT_DOUBLE_EQ(color_ratio(two, gpu), (4.0 + 0.75) / 5);
}

TEST(ColorTraffic, AStayMovesAtLeastAGranule) {
  PassWork pass = color_pass(1);
  GpuConfig gpu = sample_gpu();
  gpu.color_delta_ratio = 0.25;
  for (auto* profile : {&pass.reuse.apart, &pass.reuse.shared}) {
    MissCurve& curve = (*profile)[index_of(ReuseStream::color)];
    curve.requested_write_bytes = total(pass).mem.color_write_bytes;
    curve.write_bytes.fill(curve.requested_write_bytes);
    curve.write_stays.fill(curve.requested_write_bytes / 64);
  }
  EXPECT_DOUBLE_EQ(color_ratio(pass, gpu), 0.5);  // 32 of 64 bytes
}

TEST(ColorTraffic, AResolveReadsWhatTheFormsOfItsSourceTake) {
  PassCounters c;
  c.resolve.read_samples = 6400 * 8;
  c.resolve.written_pixels = 6400;
  c.mem.color_read_bytes = 6400 * 8 * 4;
  c.mem.color_write_bytes = 6400 * 4;
  c.crop.read_single_pixels = 6400;
  c.crop.read_single_groups_8px = 800;
  PassWork pass = repeated(PassKind::resolve, c, kChunks);
  pass.raster_samples = 8;
  pass.color_targets = {{Format::rgba8_unorm, 1, false}};
  GpuConfig gpu = sample_gpu();
  gpu.msaa_color_block_bytes = 256;
  const FrameTiming t = time_one(pass, gpu);
  EXPECT_DOUBLE_EQ(t.dram_bytes.read[kColor], 6400.0 * 4 * kChunks);
  EXPECT_DOUBLE_EQ(t.dram_bytes.write[kColor], 6400.0 * 4 * kChunks);
}

GpuConfig tiler() {
  GpuConfig gpu = sample_gpu();
  gpu.tile_based = true;
  gpu.depth_plane_slots = 0;
  return gpu;
}

/// 160x160 pixels in 8x8 tiles, of which the pass touches 100.
PassWork tiler_pass(int samples) {
  PassCounters c;
  c.mem.color_write_bytes = c.mem.depth_read_bytes = c.mem.depth_write_bytes = 999'999;  // overdraw is free
  c.crop.first_touched_tiles = c.zrop.first_touched_tiles = 10;
  c.zrop.written_samples = 100;
  PassWork pass = repeated(PassKind::draw, c, kChunks);
  pass.width_px = pass.height_px = 160;
  pass.color_targets = {{Format::rgba8_unorm, samples, false}};
  pass.depth_format = Format::d32_float;
  pass.depth_samples = samples;
  return pass;
}

TEST(TileMemory, LoadsContentsAndStoresWhatIsNeeded) {
  for (const Engine engine : {Engine::roofline, Engine::queue, Engine::detailed}) {
    const double tolerance = engine == Engine::detailed ? 3000.0 : 1e-6;  // whole lines a packet
    const auto bytes = [&](const PassWork& pass) { return time_one(pass, tiler(), engine).dram_bytes; };
    PassWork pass = tiler_pass(4);
    const double touched = 100 * 64 * 16.0, all = 160 * 160 * 16.0;
    EXPECT_NEAR(bytes(pass).write[kColor], touched, tolerance);
    EXPECT_EQ(bytes(pass).read[kColor], 0.0);
    pass.color_cleared_before = pass.depth_cleared_before = true;  // untouched tiles hold the clear
    EXPECT_NEAR(bytes(pass).write[kColor], all, tolerance);
    EXPECT_NEAR(bytes(pass).write[kDepth], all, tolerance);
    pass.depth_kept = pass.color_targets[0].kept = false;
    EXPECT_EQ(bytes(pass).total_write(), 0.0);
    pass.color_cleared_before = pass.depth_cleared_before = false;
    pass.depth_loaded = pass.color_targets[0].loaded = true;
    EXPECT_NEAR(bytes(pass).read[kColor], touched, tolerance);
    EXPECT_NEAR(bytes(pass).read[kDepth], touched, tolerance);
    EXPECT_EQ(time_one(pass, tiler(), engine).passes[0].busy_ns[static_cast<std::size_t>(Unit::l2)], 0.0);
  }
}

TEST(TileMemory, AResolveOfWhatWasJustDrawnReadsNothing) {
  PassCounters c;
  c.resolve.read_samples = 400;
  c.mem.color_read_bytes = 1600;
  c.mem.color_write_bytes = 400;
  PassWork pass = repeated(PassKind::resolve, c, kChunks);
  EXPECT_DOUBLE_EQ(time_one(pass, tiler()).dram_bytes.total_read(), 16'000.0);
  pass.source_in_tile = true;
  EXPECT_DOUBLE_EQ(time_one(pass, tiler()).dram_bytes.total_read(), 0.0);
  EXPECT_DOUBLE_EQ(time_one(pass, tiler()).dram_bytes.total_write(), 4000.0);
}

TEST(TileMemory, BinsVerticesOnceAndAnEntryForEachTriangleAndTile) {
  PassCounters c;
  c.vs.output_scalars = 300;
  c.setup.out_primitives = 50;
  c.raster.visited_tiles = 450;  // 400 beyond the first
  PassWork pass = repeated(PassKind::draw, c, kChunks);
  GpuConfig gpu = tiler();
  gpu.tile_memory_kib = 8.0;
  const auto binned = [&](double tile_px) { return 10 * (1200.0 + 8.0 * (50 + 400 * 64.0 / tile_px)); };
  const auto moved = [&] { return time_one(pass, gpu).dram_bytes; };
  EXPECT_DOUBLE_EQ(moved().write[kOther], binned(256));
  EXPECT_DOUBLE_EQ(moved().read[kOther], binned(256));
  const std::pair<int, double> cases[] = {{8, 256}, {16, 128}, {64, 32}};  // 32 bytes a pixel fit 16x16
  for (const auto& [samples, tile_px] : cases) {
    pass.color_targets = {{Format::rgba8_unorm, samples, false, false, false}};
    EXPECT_DOUBLE_EQ(moved().write[kOther], binned(tile_px)) << samples;
  }
}

TEST(TileMemory, ClearsAreFree) {
  PassWork pass;
  pass.kind = PassKind::clear;
  pass.width_px = pass.height_px = 64;
  pass.color_targets = {{Format::rgba8_unorm, 4, false}};
  pass.depth_format = Format::d32_float;
  pass.chunks.resize(1);
  EXPECT_EQ(time_one(pass, tiler()).dram_bytes.total_write(), 0.0);
}

}  // namespace
}  // namespace hwsim::test
