// The event-driven engine: each unit against its closed form, and the queue engine where one unit limits.
#include "hwsim/detailed/detailed.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hwsim/sample_gpu.h"

namespace hwsim::test {
namespace {

double ratio_to_queue(const PassWork& pass, const GpuConfig& gpu) {
  return time_one(pass, gpu, Engine::detailed).time_ns / time_one(pass, gpu, Engine::queue).time_ns;
}

PassWork one_unit(PassKind kind, void (*fill)(PassCounters&)) {
  PassCounters c;
  fill(c);
  return repeated(kind, c, 64);
}

TEST(Detailed, EqualsTheQueueWhereOneUnitLimits) {
  const GpuConfig gpu = sample_gpu();
  const std::pair<const char*, PassWork> cases[] = {
      {"fe", one_unit(PassKind::draw, [](PassCounters& c) { c.fe.draws = 100; })},
      {"ia", one_unit(PassKind::draw, [](PassCounters& c) { c.stats.input_assembly_vertices = 30'000; })},
      {"setup", one_unit(PassKind::draw, [](PassCounters& c) { c.setup.in_primitives = 10'000; })},
      {"raster", one_unit(PassKind::draw, [](PassCounters& c) { c.raster.quads = 10'000; })},
      {"hiz", one_unit(PassKind::draw, [](PassCounters& c) { c.hiz.tested_tiles = 10'000; })},
      {"zrop", one_unit(PassKind::draw, [](PassCounters& c) { c.zrop.written_samples = 400'000; })},
      {"crop", fill_pass(Format::rgba8_unorm, false, 32'768, 64)},
      {"blend", fill_pass(Format::rgba16_float, true, 32'768, 64)},
      {"resolve", one_unit(PassKind::resolve, [](PassCounters& c) { c.resolve.read_samples = 90'000; })},
      {"alu", one_unit(PassKind::full_screen,
                       [](PassCounters& c) {
                         c.stats.fragment_shader_invocations = 32'000;
                         c.shader.alu_issued_lane_ops_w32 = 32'000 * 200;
                       })},
      {"tex", one_unit(PassKind::full_screen,
                       [](PassCounters& c) {
                         c.stats.fragment_shader_invocations = 32'000;
                         c.tex.requests = c.tex.bilinear_probes = 32'000 * 8;
                         c.shader.memory_chain_lane_ops = 32'000;
                       })},
  };
  for (const auto& [name, pass] : cases) EXPECT_NEAR(ratio_to_queue(pass, gpu), 1.0, 0.02) << name;
}

// A few subgroups that live long among many packets without any: these pass by, in both engines.
TEST(Detailed, EqualsTheQueueWhereFewPacketsGoThroughTheCores) {
  PassCounters plain;
  plain.raster.quads = 512;
  PassCounters shaded = plain;
  shaded.stats.fragment_shader_invocations = 32 * 4;
  shaded.shader.alu_chain_lane_ops = 32 * 4 * 500;
  PassWork pass = repeated(PassKind::draw, plain, 64);
  for (std::size_t k = 0; k < pass.chunks.size(); k += 8) pass.chunks[k] = shaded;
  GpuConfig gpu = sample_gpu();
  gpu.alu_latency_cycles = 10;
  EXPECT_NEAR(ratio_to_queue(pass, gpu), 1.0, 0.02);  // 64 x 64 clocks of the rasterizer, and one life
  EXPECT_NEAR(time_one(pass, gpu).time_ns, 56 * 64.0 + 64.0 + 5000.0, 200.0);
}

TEST(Detailed, L2AndDramReachTheirPeaks) {
  GpuConfig gpu = sample_gpu();
  PassCounters c;
  c.mem.color_read_bytes = 1'000'000;
  const PassWork pass = repeated(PassKind::resolve, c, 16);
  gpu.l2_bytes_per_clk = 100.0;
  EXPECT_NEAR(time_one(pass, gpu, Engine::detailed).time_ns / (16e6 / 100.0), 1.0, 0.02);
  gpu.l2_bytes_per_clk = 5000.0;
  gpu.dram_bandwidth_gb_s = 100.0;  // rows are read in order: the bus never waits
  EXPECT_NEAR(time_one(pass, gpu, Engine::detailed).time_ns / (16e6 / 100.0), 1.0, 0.02);
  EXPECT_NEAR(time_one(pass, gpu, Engine::detailed).dram_bytes.total_read(), 16e6, 16e6 * 0.01);
}

/// One subgroup alone: what it waits for adds up.
TEST(Detailed, AnUnloadedSubgroupTakesTheSumOfItsLatencies) {
  GpuConfig gpu = sample_gpu();
  gpu.alu_latency_cycles = 10;
  gpu.tex_latency_cycles = 100;
  PassCounters c;
  c.stats.fragment_shader_invocations = 32;
  c.shader.alu_chain_lane_ops = 32 * 20;
  c.shader.memory_chain_lane_ops = 32 * 3;
  PassWork pass = repeated(PassKind::full_screen, c, 1);
  EXPECT_NEAR(time_one(pass, gpu, Engine::detailed).time_ns, 20 * 10 + 3 * 100.0, 1e-6);
  gpu.l2_latency_cycles = 300;
  gpu.dram_latency_cycles = 700;
  pass.chunks[0].shader.memory_chain_lane_ops = 32;
  pass.chunks[0].mem.storage_read_bytes = 64;  // one line, never read before, in a closed row
  EXPECT_NEAR(time_one(pass, gpu, Engine::detailed).time_ns, 20 * 10 + 700.0, 1.0);
}

/// Subgroups of 32 one-clock operations that then wait 100 clocks, so many a core: 101 / 1 of them keep a
/// core busy.
double time_of_waiting_subgroups_ns(int subgroups_a_core, double residents) {
  PassCounters c;
  c.stats.fragment_shader_invocations = static_cast<std::uint64_t>(32 * 10 * subgroups_a_core);
  c.shader.alu_issued_lane_ops_w32 = c.stats.fragment_shader_invocations;
  c.shader.memory_chain_lane_ops = c.stats.fragment_shader_invocations;
  const PassWork pass = repeated(PassKind::full_screen, c, 1);
  GpuConfig gpu = sample_gpu();
  gpu.tex_latency_cycles = 100;
  gpu.raster_px_per_engine_clk = gpu.export_px_per_clk = 1e5;
  gpu.subgroups_per_core_max = residents;
  return time_one(pass, gpu, Engine::detailed).time_ns;
}

TEST(Detailed, ResidencyHidesLatencyUpToTheGate) {
  const auto time_with = [](double residents) { return time_of_waiting_subgroups_ns(800, residents); };
  for (const double residents : {101.0, 200.0}) {  // at the gate the pipe is always busy; beyond it, no gain
    EXPECT_GE(time_with(residents), 800.0);
    EXPECT_LE(time_with(residents), 800.0 + 100.0 + 40.0);
  }
  EXPECT_NEAR(time_with(50) / (800 * 101 / 50.0), 1.0, 0.05);  // below: Little's law
  EXPECT_NEAR(time_with(1) / (800 * 101.0), 1.0, 0.02);
}

// 101 residents keep the pipe of the test before busy: one less leaves it idle a clock in 101, one more
// brings nothing.
TEST(Detailed, TheGateOfResidencyIsOneSubgroupWide) {
  const auto time_with = [](double residents) { return time_of_waiting_subgroups_ns(8000, residents); };
  EXPECT_NEAR(time_with(100) - time_with(101), 8000.0 / 100, 5.0);
  EXPECT_NEAR(time_with(102) - time_with(103), 0.0, 5.0);  // at 101, halves of two subgroups still collide
}

TEST(Detailed, RowsThatAreOpenedForEveryLineBoundTheBanks) {
  GpuConfig gpu = sample_gpu();
  gpu.dram_channels = 1;
  gpu.dram_banks = 4;
  gpu.dram_row_bytes = 1024;
  gpu.dram_bandwidth_gb_s = 64.0;  // a line a nanosecond
  gpu.dram_row_cycle_ns = 40.0;
  Dram dram(gpu);
  double done = 0.0;
  for (std::uint64_t i = 0; i < 4000; ++i) done = std::max(done, dram.access(i * 16 * 7, false, 0.0));
  EXPECT_EQ(dram.row_misses(), 4000u);
  EXPECT_GT(done, 4000 * 40.0 / 4 * 0.9);  // a bank opens a row each 40 ns
  Dram in_order(gpu);
  for (std::uint64_t i = 0; i < 4000; ++i) done = in_order.access(i, false, 0.0);
  EXPECT_EQ(in_order.row_misses(), 4000u / 16);
  EXPECT_LT(done, 4000 * 1.1 + 500);
}

TEST(Detailed, TurningTheBusCostsTimeOnceAGroupOfWrites) {
  GpuConfig gpu = sample_gpu();
  gpu.dram_channels = 1;
  gpu.dram_bandwidth_gb_s = 64.0;
  gpu.dram_turn_ns = 10.0;
  Dram dram(gpu);
  for (std::uint64_t i = 0; i < 320; ++i) {
    dram.access(i, false, 0.0);
    dram.access(100'000 + i, true, 0.0);
  }
  EXPECT_NEAR(dram.busy_ns(), 640.0 + 10.0 * (10 + 9), 11.0);  // ten groups of 32 writes
}

TEST(Detailed, CachesKeepWhatTheCurvesSay) {
  // Half of the requests are reuses within 100 KiB: they hit in an L2 of 256 KiB and miss in one of 32 KiB.
  PassCounters c;
  c.stats.fragment_shader_invocations = 3200;
  c.shader.memory_chain_lane_ops = 3200;
  c.mem.storage_read_bytes = 64 * 2000;
  PassWork pass = repeated(PassKind::compute, c, 20);
  MissCurve curve;
  curve.requested_read_bytes = total(pass).mem.storage_read_bytes;
  for (std::size_t k = 0; k < kCacheSizes; ++k)
    curve.read_bytes[k] = k < 6 ? curve.requested_read_bytes : curve.requested_read_bytes / 2;
  pass.reuse.apart[index_of(ReuseStream::storage)] = pass.reuse.shared[index_of(ReuseStream::storage)] =
      curve;
  GpuConfig gpu = sample_gpu();
  const auto moved = [&](double kib) {
    gpu.l2_size_kib = kib;
    return time_one(pass, gpu, Engine::detailed).dram_bytes.total_read() /
           static_cast<double>(curve.requested_read_bytes);
  };
  EXPECT_NEAR(moved(512), 0.5, 0.05);
  EXPECT_GT(moved(16), 0.9);
}

TEST(Detailed, IsTheSameEveryTimeAndItsInvariantsHold) {
  WorkTrace trace;
  trace.passes = {busy_pass(60), fill_pass(Format::rgba8_unorm, true, 4096, 64), PassWork{}};
  GpuConfig gpu = sample_gpu();
  gpu.dram_bandwidth_gb_s = 60.0;
  const FrameTiming a = time_frame(trace, gpu, Engine::detailed),
                    b = time_frame(trace, gpu, Engine::detailed);
  EXPECT_EQ(a.time_ns, b.time_ns);
  EXPECT_EQ(a.dram_bytes.read, b.dram_bytes.read);
  for (const std::string& broken : check_timing(a, trace, gpu)) ADD_FAILURE() << broken;
}

/// Chunks whose cost changes along the pass.
PassWork uneven_pass() {
  PassWork pass;
  pass.name = "uneven";
  pass.kind = PassKind::full_screen;
  for (std::uint64_t k = 0; k < 400; ++k) {
    PassCounters c;
    c.stats.fragment_shader_invocations = 9600;
    c.shader.alu_issued_lane_ops_w32 = 9600 * (50 + 4 * ((k * 37) % 100));
    c.shader.memory_chain_lane_ops = 9600 * 2;
    c.tex.bilinear_probes = c.tex.requests = 9600 * 2;
    pass.chunks.push_back(c);
  }
  return pass;
}

/// What L2 has to write back later slows a pass down: a sample that began with empty caches would miss it.
PassWork writing_pass() {
  PassWork pass = uneven_pass();
  pass.color_targets = {{Format::rgba8_unorm, 1, false}};
  for (std::size_t k = 0; k < pass.chunks.size(); ++k) {
    pass.chunks[k].mem.color_write_bytes = k % 3 == 0 ? 160'000 : 20'000;
    pass.chunks[k].mem.color_read_bytes = 30'000;
  }
  set_reuse(pass, 0.3);
  return pass;
}

struct SampleErrors {
  double mean_ratio = 0.0, mean_bytes_ratio = 0.0, largest_part = 0.0;
  int covered = 0;
};

SampleErrors errors_of_samples(const PassWork& pass, const GpuConfig& gpu, double part, int seeds) {
  const GpuRates<double> rates = derive_rates<double>(gpu);
  const DetailedTime whole = detailed_time(pass, gpu, rates, {}, 1);
  TimingOptions options;
  options.detailed_sample_ratio = part;
  SampleErrors errors;
  for (int seed = 1; seed <= seeds; ++seed) {
    const DetailedTime sample = detailed_time(pass, gpu, rates, options, static_cast<std::uint64_t>(seed));
    if (!sample.interval_ns) return {};
    errors.mean_ratio += sample.time.time_ns / whole.time.time_ns / seeds;
    errors.mean_bytes_ratio += sample.time.dram.total() / whole.time.dram.total() / seeds;
    const auto [low, high] = *sample.interval_ns;
    errors.covered += low <= whole.time.time_ns && whole.time.time_ns <= high ? 1 : 0;
    errors.largest_part = std::max(errors.largest_part, static_cast<double>(sample.simulated_packets) /
                                                            static_cast<double>(sample.packets));
  }
  return errors;
}

// No allowance: the mean of many samples is the whole, and nine of ten intervals hold it.
TEST(Detailed, SamplesAreRightInTheMeanAndTheirIntervalsHoldTheWhole) {
  GpuConfig gpu = sample_gpu();
  gpu.subgroups_per_core_max = 12;
  GpuConfig writes = gpu;
  writes.dram_bandwidth_gb_s = 120.0;
  constexpr double kPart = 0.15;
  constexpr int kSeeds = 20, kCoveredMin = 15;  // 18 are expected; fewer than 15 come in one of a hundred
  const SampleErrors computing = errors_of_samples(uneven_pass(), gpu, kPart, kSeeds);
  EXPECT_NEAR(computing.mean_ratio, 1.0, 0.01);
  EXPECT_GE(computing.covered, kCoveredMin);
  EXPECT_LT(computing.largest_part, kPart + 0.05);
  const SampleErrors writing = errors_of_samples(writing_pass(), writes, kPart, kSeeds);
  EXPECT_NEAR(writing.mean_ratio, 1.0, 0.01);
  EXPECT_NEAR(writing.mean_bytes_ratio, 1.0, 0.04);  // accesses that are left out while L2 goes on
  EXPECT_GE(writing.covered, kCoveredMin);
}

TEST(Detailed, PassesTooShortForWindowsAreSimulatedWhole) {
  PassWork pass = uneven_pass();
  pass.chunks.resize(8);
  TimingOptions options;
  options.detailed_sample_ratio = 0.1;
  const GpuConfig gpu = sample_gpu();
  const DetailedTime time = detailed_time(pass, gpu, derive_rates<double>(gpu), options, 1);
  EXPECT_FALSE(time.interval_ns.has_value());
  EXPECT_EQ(time.simulated_packets, time.packets);
}

TEST(Detailed, AStallIsReportedWithItsPlace) {
  TimingOptions options;
  options.events_without_progress_max = 2;
  WorkTrace trace;
  trace.passes = {uneven_pass()};
  try {
    time_frame(trace, sample_gpu(), Engine::detailed, options);
    ADD_FAILURE() << "expected a report";
  } catch (const StallError& error) {
    const std::string text = error.what();
    for (const char* part : {"uneven", "packet", "crop", "dram", "resident"})
      EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
  }
}

}  // namespace
}  // namespace hwsim::test
