// Each unit of the event-driven engine alone: its peak rate, the time of one packet in an empty machine, and
// the place where the queue behind it is full.
#include <gtest/gtest.h>

#include <functional>

#include "hwsim/detailed/machine.h"
#include "hwsim/sample_gpu.h"

namespace hwsim::test {
namespace {

using Fill = std::function<void(PassCounters&)>;

struct UnitCase {
  const char* name;
  PassKind kind;
  Fill fill;
  double ns;  ///< time of a chunk, from the literal rates of sample_gpu
  int raster_samples = 1;
};

Fill shading(std::function<void(PassCounters&)> more) {
  return [more](PassCounters& c) {
    c.stats.fragment_shader_invocations = 32'000;
    more(c);
  };
}

const std::vector<UnitCase>& unit_cases() {
  using P = PassCounters;
  constexpr PassKind kDraw = PassKind::draw, kScreen = PassKind::full_screen;
  static const std::vector<UnitCase> cases = {
      {"fe, draws", kDraw, [](P& c) { c.fe.draws = 200; }, 200 * 8.0},
      {"fe, state", kDraw, [](P& c) { c.fe.state_changes = 100; }, 100 * 16.0},
      {"ia", kDraw, [](P& c) { c.stats.input_assembly_vertices = 21'000; }, 21'000 / 10.5},
      {"vs", kDraw, [](P& c) { c.vs.alu_lane_ops = 640'000; }, 640'000 / 320.0},
      {"vs, geometry shader's output", kDraw, [](P& c) { c.gs.output_bytes = 320'000; }, 320'000 / 4 / 40.0},
      {"setup, culled", kDraw, [](P& c) { c.setup.in_primitives = 7'000; }, 7'000 / 3.5},
      {"setup, drawn", kDraw, [](P& c) { c.setup.in_primitives = c.setup.out_primitives = 4'000; },
       4'000 / 2.0},
      {"raster, pixels", kDraw, [](P& c) { c.raster.quads = 16'000; }, 64'000 / 32.0},
      {"raster, samples", kDraw, [](P& c) { c.raster.covered_samples = 512'000; }, 512'000 / 256.0, 16},
      {"raster, tiles", kDraw, [](P& c) { c.raster.visited_tiles = 8'000; }, 8'000 / 4.0},
      {"hiz", kDraw, [](P& c) { c.hiz.tested_tiles = 16'000; }, 16'000 * 64 / 512.0},
      {"zrop, tests", kDraw, [](P& c) { c.zrop.early_z_tested_samples = 320'000; }, 320'000 / 160.0},
      {"zrop, writes", kDraw, [](P& c) { c.zrop.written_samples = 320'000; }, 320'000 / 160.0},
      {"alu", kScreen, shading([](P& c) { c.shader.alu_issued_lane_ops_w32 = 6'400'000; }),
       6'400'000 / 320.0},
      {"sfu", kScreen, shading([](P& c) { c.shader.sfu_issued_lane_ops_w32 = 1'600'000; }), 1'600'000 / 80.0},
      {"interpolation", kScreen, shading([](P& c) { c.shader.interp_lane_ops = 1'600'000; }),
       1'600'000 / 80.0},
      {"loads and stores", kScreen,
       shading([](P& c) { c.shader.load_lane_ops = c.shader.store_lane_ops = 1'600'000; }),
       3'200'000 / 160.0},
      {"group memory", kScreen, shading([](P& c) { c.shader.group_memory_lane_ops = 6'400'000; }),
       6'400'000 / 320.0},
      {"atomics", kScreen, shading([](P& c) { c.shader.atomic_lane_ops = 640'000; }), 640'000 / 64.0},
      {"atomics, one address", kScreen,
       shading([](P& c) { c.shader.atomic_lane_ops = c.shader.same_address_atomic_lane_ops = 16'000; }),
       16'000.0},
      {"tex, probes", kScreen, shading([](P& c) { c.tex.bilinear_probes = 800'000; }), 800'000 / 40.0},
      {"tex, gathers", kScreen, shading([](P& c) { c.tex.gathers = 640'000; }), 640'000 / 0.8 / 40.0},
      {"tex, comparisons", kScreen, shading([](P& c) { c.tex.comparisons = 400'000; }), 400'000 * 2 / 40.0},
      {"tex, 64-bit texels", kScreen, shading([](P& c) { c.tex.fetched_64bit_texels = 400'000; }),
       400'000 * 2 / 40.0},
      {"tex, 128-bit texels", kScreen, shading([](P& c) { c.tex.fetched_128bit_texels = 200'000; }),
       200'000 * 4 / 40.0},
      {"resolve", PassKind::resolve, [](P& c) { c.resolve.read_samples = 80'000; }, 80'000 / 40.0},
  };
  return cases;
}

TEST(DetailedUnits, ReachTheirPeakRates) {
  constexpr std::size_t kChunks = 32;
  for (const UnitCase& unit : unit_cases()) {
    PassCounters c;
    unit.fill(c);
    PassWork pass = repeated(unit.kind, c, kChunks);
    pass.raster_samples = unit.raster_samples;
    const double ns = time_one(pass, sample_gpu(), Engine::detailed).time_ns;
    EXPECT_NEAR(ns / (kChunks * unit.ns), 1.0, 0.015) << unit.name;
  }
}

/// Packets made by hand, on a machine of one core.
struct Bench {
  PassWork pass;
  GpuConfig gpu = [] {
    GpuConfig g = sample_gpu();
    g.shader_cores = 1;
    g.queue_packets = 8;
    return g;
  }();
  PacketPlan plan;

  ChunkPackets& add(std::uint64_t packets, double subgroups = 0.0) {
    ChunkPackets chunk;
    chunk.first = plan.packets;
    chunk.count = packets;
    chunk.subgroups = subgroups;
    plan.packets += packets;
    plan.chunks.push_back(chunk);
    return plan.chunks.back();
  }
  double ns() const {
    const GpuRates<double> rates = derive_rates<double>(gpu);
    Machine machine(pass, plan, gpu, rates, 1'000'000, 1);
    machine.enter_until(plan.packets);
    return machine.drain().ns;
  }
};

TEST(DetailedUnits, OnePacketAloneTakesTheSumOfItsServices) {
  double sum = 0.0, service = 1.0;
  Bench all;
  ChunkPackets& chunk = all.add(1, 1.0);
  for (const Unit unit : kFrontUnits) {
    Bench alone;
    alone.add(1).service_ns[index_of(unit)] = service;
    EXPECT_DOUBLE_EQ(alone.ns(), service) << unit_name(unit);
    chunk.service_ns[index_of(unit)] = service;
    sum += service++;
  }
  for (const Unit unit : {Unit::crop, Unit::resolve}) {
    Bench alone;
    alone.add(1).service_ns[index_of(unit)] = 3.0;
    EXPECT_DOUBLE_EQ(alone.ns(), 3.0) << unit_name(unit);
  }
  chunk.service_ns[index_of(Unit::crop)] = 40.0;
  const auto with_pipe = [&all, sum](double SubgroupWork::*pipe) {
    Bench bench = all;
    bench.plan.chunks[0].work.*pipe = 200.0;
    EXPECT_DOUBLE_EQ(bench.ns(), sum + 200.0 + 40.0);
  };
  for (double SubgroupWork::*pipe :
       {&SubgroupWork::alu_ns, &SubgroupWork::sfu_ns, &SubgroupWork::memory_pipe_ns, &SubgroupWork::atomic_ns,
        &SubgroupWork::alu_chain_ns})
    with_pipe(pipe);
  all.plan.chunks[0].work.tex_ns = 30.0;  // and the way to the texture unit and back
  EXPECT_DOUBLE_EQ(all.ns(), sum + 30.0 + all.gpu.tex_latency_cycles + 40.0);
}

// Behind a unit that works lies one that is busy with earlier packets, which cost the first nothing: the
// queue holds them, or the unit has to wait for the first of them.
TEST(DetailedUnits, WaitWhenTheQueueBehindThemIsFullAndNotOnePacketEarlier) {
  for (std::size_t u = 0; u + 1 < kFrontUnits.size(); ++u)
    for (const std::uint64_t packets : {7u, 8u}) {
      Bench bench;
      bench.add(packets).service_ns[index_of(kFrontUnits[u + 1])] = 3.0;
      bench.add(packets).service_ns[index_of(kFrontUnits[u])] = 5.0;
      const double waits = packets < 8 ? 0.0 : 3.0;
      EXPECT_DOUBLE_EQ(bench.ns(), waits + 5.0 * static_cast<double>(packets))
          << unit_name(kFrontUnits[u]) << " " << packets;
    }
}

TEST(DetailedUnits, SubgroupsKeepTheirPlacesWhenTheQueueToTheRopsIsFullAndNotOneEarlier) {
  for (const std::uint64_t packets : {8u, 9u}) {
    Bench bench;
    bench.add(packets, static_cast<double>(packets)).service_ns[index_of(Unit::crop)] = 3.0;
    bench.add(packets, static_cast<double>(packets)).work.alu_ns = 5.0;
    const double waits = packets < 9 ? 0.0 : 3.0;
    EXPECT_DOUBLE_EQ(bench.ns(), waits + 5.0 * static_cast<double>(packets)) << packets;
  }
}

TEST(DetailedUnits, PacketsWithoutSubgroupsPassThoseThatWaitForTheRops) {
  Bench bench;
  bench.add(1, 1.0).service_ns[index_of(Unit::crop)] = 1000.0;
  ChunkPackets& mixed = bench.add(101, 1.0);
  mixed.service_ns[index_of(Unit::raster)] = 5.0;
  EXPECT_DOUBLE_EQ(bench.ns(), 1000.0);
}

TEST(DetailedUnits, MemoryTakesTheLatencyOfItsLevel) {
  GpuConfig gpu = sample_gpu();
  gpu.tex_latency_cycles = 100;
  gpu.l2_latency_cycles = 250;
  gpu.dram_latency_cycles = 700;
  gpu.l2_bytes_per_clk = 64.0;  // a line a clock
  MemorySystem memory(gpu, 1);
  Survival always{}, never{};
  always.fill(1.0);
  never.fill(0.0);
  const auto read = [&memory](const Survival& survival, double now) {
    return memory.access(MemoryClient::reads, Stream::storage, survival, 1.0, false, false, now) - now;
  };
  // What L1 takes is part of every request's way: the rest is asked of here, and the line's own transfer.
  EXPECT_NEAR(read(always, 0.0), 1.0 + 700 - 100, 1e-9);
  for (int i = 0; i < 64; ++i) read(always, 0.0);
  EXPECT_NEAR(read(never, 10'000.0), 1.0 + 250 - 100, 1e-9);
}

// The line that the buffers have no place for waits for the first to come.
TEST(DetailedUnits, FixedFunctionUnitsWaitWhenTheirLinesAreOnTheirWayAndNotOneEarlier) {
  GpuConfig gpu = sample_gpu();
  gpu.tex_latency_cycles = 100;
  gpu.dram_latency_cycles = 700;
  gpu.unit_lines_max = 82'031.25;
  const GpuRates<double> rates = derive_rates<double>(gpu);
  PassCounters c;
  c.mem.vertex_read_bytes = 64;
  PassWork pass = repeated(PassKind::draw, c, 1);
  set_reuse(pass, 1.0);  // nothing is found again
  for (const double more : {0.0, 1.0}) {
    Bench bench;
    bench.plan.reaches_l2.read.fill(1.0);
    bench.plan.run_lines.read.fill(1.0);
    ChunkPackets& chunk = bench.add(1);
    chunk.l2.read[index_of(Stream::vertex)] = 64.0 * (std::floor(rates.unit_lines) + more);
    chunk.service_ns[index_of(Unit::ia)] = 1.0;
    Machine machine(pass, bench.plan, gpu, rates, 1'000'000, 1);
    EXPECT_NEAR(machine.enter_until(1).ns, 1.0 + more * (700 - 100), 0.1) << more;
  }
}

/// Lines of rows of one bank of the only channel, `rows` rows in turn.
std::uint64_t openings(GpuConfig gpu, std::uint64_t rows) {
  gpu.dram_channels = gpu.dram_banks = 1;
  gpu.dram_row_bytes = 1024;
  Dram dram(gpu);
  for (std::uint64_t turn = 0; turn < 8; ++turn)
    for (std::uint64_t row = 0; row < rows; ++row) dram.access(16 * row + turn, false, 0.0);
  return dram.row_misses();
}

TEST(DetailedUnits, AQueueOfRowsOpensNoRowTwiceThatItHoldsAndEveryOneThatItDoesNot) {
  EXPECT_EQ(openings(sample_gpu(), 4), 4u);  // the default holds four
  EXPECT_EQ(openings(sample_gpu(), 5), 40u);
  GpuConfig one = sample_gpu();
  one.dram_queue_rows = 1;
  EXPECT_EQ(openings(one, 1), 1u);
  EXPECT_EQ(openings(one, 2), 16u);
}

}  // namespace
}  // namespace hwsim::test
