// Closed forms of the cores' residency, latency, instruction words and contended atomics.
#include <gtest/gtest.h>

#include "hwsim/sample_gpu.h"

namespace hwsim::test {
namespace {

constexpr std::uint64_t kLanes = 320'000;  // 10'000 subgroups of 32, 1000 for each of 10 cores

PassWork waiting_pass(std::uint64_t alu_chain, std::uint64_t memory_chain, std::uint64_t registers) {
  PassCounters c;
  c.stats.fragment_shader_invocations = kLanes;
  c.shader.alu_chain_lane_ops = alu_chain * kLanes;
  c.shader.memory_chain_lane_ops = memory_chain * kLanes;
  c.shader.register_lanes = registers * kLanes;
  c.tex.requests = memory_chain * kLanes;
  return repeated(PassKind::full_screen, c, 1);
}

GpuConfig latency_gpu() {
  GpuConfig gpu = sample_gpu();
  gpu.registers_kib_per_core = 64;  // 16384 registers: 512 for each lane of a subgroup
  gpu.subgroups_per_core_max = 16;
  gpu.alu_latency_cycles = 10;
  gpu.tex_latency_cycles = 100;
  gpu.l2_latency_cycles = 200;
  gpu.dram_latency_cycles = 500;
  return gpu;
}

double shader_ns(const PassWork& pass, const GpuConfig& gpu) {
  return time_one(pass, gpu).passes[0].busy_ns[static_cast<std::size_t>(Unit::shader)];
}

TEST(Latency, ACoreWithNResidentSubgroupsTakesTheLifeOfOneForNOfThem) {
  // 1000 subgroups a core, 16 at once, each lives 8 x 10 ns.
  EXPECT_DOUBLE_EQ(shader_ns(waiting_pass(8, 0, 1), latency_gpu()), 1000.0 / 16 * 80);
  EXPECT_DOUBLE_EQ(shader_ns(waiting_pass(8, 2, 1), latency_gpu()), 1000.0 / 16 * 280);
}

TEST(Latency, RegistersBoundTheResidentSubgroups) {
  EXPECT_DOUBLE_EQ(shader_ns(waiting_pass(8, 0, 32), latency_gpu()), 1000.0 / 16 * 80);  // the gate: 16
  EXPECT_DOUBLE_EQ(shader_ns(waiting_pass(8, 0, 64), latency_gpu()), 1000.0 / 8 * 80);
  GpuConfig gpu = latency_gpu();
  gpu.registers_per_invocation_max = 4096;
  EXPECT_DOUBLE_EQ(shader_ns(waiting_pass(8, 0, 4000), gpu), 1000.0 * 80);  // one always runs
}

TEST(Latency, GroupMemoryBoundsTheResidentSubgroups) {
  GpuConfig gpu = latency_gpu();
  gpu.group_memory_kib_per_core = 32;
  PassWork pass = waiting_pass(8, 0, 1);
  pass.group_memory_lane_bytes = 128;  // SBAA's counters: 4 KiB a subgroup of 32
  EXPECT_DOUBLE_EQ(shader_ns(pass, gpu), 1000.0 / 8 * 80);
  pass.group_memory_lane_bytes = 16;  // 64 subgroups would fit: the gate
  EXPECT_DOUBLE_EQ(shader_ns(pass, gpu), 1000.0 / 16 * 80);
  pass.group_memory_lane_bytes = 4096;
  EXPECT_DOUBLE_EQ(shader_ns(pass, gpu), 1000.0 * 80);  // one always runs
}

TEST(Latency, ARequestWaitsForItsSlowestLevel) {
  PassWork pass = waiting_pass(0, 1, 1);
  PassCounters& c = pass.chunks[0];
  c.mem.storage_read_bytes = 64 * 5000;  // half of the 10'000 requests go to L2, and on to DRAM
  const double half = shader_ns(pass, latency_gpu());
  EXPECT_NEAR(half, 1000.0 / 16 * (0.5 * 100 + 0.5 * 500), 1e-6);
  set_reuse(pass, 0.5);
  GpuConfig gpu = latency_gpu();
  gpu.l2_size_kib = 1024.0 * 1024.0;  // keeps all that can be kept
  EXPECT_NEAR(shader_ns(pass, gpu), 1000.0 / 16 * (0.5 * 100 + 0.25 * 200 + 0.25 * 500), 1e-6);
}

TEST(Latency, IsHiddenByEnoughWork) {
  PassWork pass = waiting_pass(8, 0, 1);
  pass.chunks[0].shader.alu_issued_lane_ops_w32 = 100 * kLanes;  // 100 clocks a subgroup and core
  EXPECT_DOUBLE_EQ(shader_ns(pass, latency_gpu()), 100.0 * 1000);
}

TEST(Latency, WithOneResidentSubgroupWorkAndMemoryTakeTurns) {
  GpuConfig gpu = latency_gpu();
  gpu.subgroups_per_core_max = 1;
  PassWork pass = waiting_pass(8, 2, 1);
  pass.chunks[0].shader.alu_issued_lane_ops_w32 = 100 * kLanes;
  EXPECT_DOUBLE_EQ(shader_ns(pass, gpu), 1000.0 * (100 + 200));
}

TEST(Vliw, WordsAreNoFullerThanTheShaderAllowsAndNotFullerThanTheAverage) {
  GpuConfig gpu = sample_gpu();
  gpu.fp32_lanes_per_core = 80;
  gpu.sfu_lanes_per_core = 16;
  gpu.vliw_slots = 5;
  gpu.vliw_fill_slots = 4;
  gpu.subgroup_size = 64;
  PassCounters c;
  c.shader.alu_issued_lane_ops_w64 = 48'000;
  c.shader.sfu_issued_lane_ops_w64 = 16'000;
  c.shader.vliw5_issued_words_w64 = 12'800;  // perfectly packed: the average fill limits
  EXPECT_DOUBLE_EQ(shader_ns(repeated(PassKind::full_screen, c, 1), gpu), 64'000.0 / (10 * 16 * 4));
  c.shader.vliw5_issued_words_w64 = 32'000;  // a chain: two slots filled
  EXPECT_DOUBLE_EQ(shader_ns(repeated(PassKind::full_screen, c, 1), gpu), 32'000.0 / (10 * 16));
}

TEST(Vliw, WordsOfFourSlotsHoldNoMoreAndSpecialFunctionsTakeThreeOfThem) {
  GpuConfig gpu = sample_gpu();
  gpu.fp32_lanes_per_core = 64;
  gpu.sfu_lanes_per_core = 16;
  gpu.vliw_slots = 4;
  gpu.vliw_fill_slots = 3.2;
  gpu.vliw_sfu_slots = 3;
  gpu.subgroup_size = 64;
  PassCounters c;
  c.shader.alu_issued_lane_ops_w64 = 48'000;
  c.shader.sfu_issued_lane_ops_w64 = 16'000;
  EXPECT_DOUBLE_EQ(shader_ns(repeated(PassKind::full_screen, c, 1), gpu),
                   (48'000.0 + 3 * 16'000.0) / (10 * 16 * 3.2));
  c.shader.vliw5_issued_words_w64 = 64'000;  // a chain: one slot filled
  EXPECT_DOUBLE_EQ(shader_ns(repeated(PassKind::full_screen, c, 1), gpu), 64'000.0 / (10 * 16));
}

TEST(Registers, ValuesBeyondWhatInstructionsCanNameAreStoredAndLoaded) {
  GpuConfig gpu = sample_gpu();
  gpu.registers_per_invocation_max = 63;
  PassCounters c;
  c.stats.compute_shader_invocations = 3200;
  c.shader.register_lanes = 63 * 3200;
  EXPECT_DOUBLE_EQ(shader_ns(repeated(PassKind::compute, c, 1), gpu), 0.0);
  c.shader.register_lanes = 73 * 3200;
  EXPECT_DOUBLE_EQ(shader_ns(repeated(PassKind::compute, c, 1), gpu),
                   2.0 * 10 * 3200 / (10 * gpu.load_words_per_core_clk));
}

TEST(Registers, ThoseSpilledHoldNoRoomForOtherSubgroups) {
  GpuConfig gpu = latency_gpu();
  PassWork pass = waiting_pass(0, 1, 1);
  PassCounters& c = pass.chunks[0];
  c.shader.register_lanes = 200 * kLanes;
  gpu.registers_kib_per_core = 128;  // 32'768 words: 5 subgroups with 200 registers, 16 with 64
  gpu.registers_per_invocation_max = 4096;
  const double held = shader_ns(pass, gpu);
  gpu.registers_per_invocation_max = 64;
  gpu.load_words_per_core_clk = 1e5;
  EXPECT_NEAR(held / shader_ns(pass, gpu), 200.0 / 64.0, 1e-2);
}

TEST(Atomics, OfOneAddressTakeTurns) {
  GpuConfig gpu = sample_gpu();
  gpu.atomic_lane_ops_per_clk = 24;
  gpu.atomic_same_address_ops_per_clk = 1.0 / 9.0;
  PassCounters c;
  c.shader.atomic_lane_ops = 2400;
  EXPECT_DOUBLE_EQ(shader_ns(repeated(PassKind::compute, c, 1), gpu), 100.0);
  c.shader.same_address_atomic_lane_ops = 2400;
  EXPECT_NEAR(shader_ns(repeated(PassKind::compute, c, 1), gpu), 21'600.0, 1e-6);
}

// AMD's guide to OpenCL: what is narrower than 32 bits and atomics are stored by one path.
TEST(NarrowStores, ShareThePathOfAtomics) {
  GpuConfig gpu = sample_gpu();
  gpu.atomic_lane_ops_per_clk = 24;
  gpu.narrow_stores_per_clk = 2;
  PassCounters c;
  c.shader.store_lane_ops = c.shader.narrow_store_lane_ops = 200;
  EXPECT_DOUBLE_EQ(shader_ns(repeated(PassKind::compute, c, 1), gpu), 100.0);
  c.shader.atomic_lane_ops = 2400;
  EXPECT_DOUBLE_EQ(shader_ns(repeated(PassKind::compute, c, 1), gpu), 200.0);
}

TEST(Texture, UnfilteredTexelsCostTheRatioOfTheirSize) {
  GpuConfig gpu = sample_gpu();
  PassCounters c;
  c.tex.bilinear_probes = 4000;
  c.tex.fetched_32bit_texels = 400;
  c.tex.fetched_64bit_texels = 200;
  c.tex.fetched_128bit_texels = 100;
  const FrameTiming t = time_one(repeated(PassKind::full_screen, c, 1), gpu);
  EXPECT_DOUBLE_EQ(t.passes[0].busy_ns[static_cast<std::size_t>(Unit::tex)],
                   (4000.0 + 400 + 200 * 2 + 100 * 4) / 40);
}

TEST(Texture, AGatherAndAComparisonTakeOneSlotAtTheirRates) {
  GpuConfig gpu = sample_gpu();
  PassCounters c;
  c.tex.requests = 1200;
  c.tex.gathers = 800;
  c.tex.comparisons = 400;
  const FrameTiming t = time_one(repeated(PassKind::full_screen, c, 1), gpu);
  EXPECT_DOUBLE_EQ(t.passes[0].busy_ns[static_cast<std::size_t>(Unit::tex)], (800 / 0.8 + 400 / 0.5) / 40);
}

}  // namespace
}  // namespace hwsim::test
