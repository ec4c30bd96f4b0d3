// Derivatives along the longest path against those that are carried forward through every chunk.
#include "hwsim/timing/time_slopes.h"

#include <random>

#include "hwsim/forward_slopes.h"
#include "hwsim/sample_gpu.h"

namespace hwsim::test {
namespace {

/// Chunks that differ by orders of magnitude, so that the longest path changes between units and units block
/// each other.
PassWork uneven_pass(std::uint32_t seed, PassKind kind) {
  std::mt19937 random(seed);
  PassWork pass = busy_pass(40 + seed % 50);
  pass.kind = kind;
  for (PassCounters& chunk : pass.chunks) {
    const auto shift = random() % 9;
    for (std::uint64_t& value : values(chunk))
      value = (value * (1 + random() % 64)) >> (random() % 6) >> shift;
  }
  set_reuse(pass, 0.2);
  return pass;
}

WorkTrace uneven_trace(std::uint32_t seed) {
  WorkTrace trace;
  trace.passes = {uneven_pass(seed, PassKind::draw), uneven_pass(seed + 1, PassKind::clear),
                  uneven_pass(seed + 2, PassKind::full_screen), uneven_pass(seed + 3, PassKind::compute),
                  uneven_pass(seed + 4, PassKind::resolve)};
  for (std::size_t p = 1; p < trace.passes.size(); ++p) trace.passes[p].barrier_before = p % 2 == 0;
  return trace;
}

std::vector<GpuConfig> unlike_gpus() {
  std::vector<GpuConfig> gpus(5, sample_gpu());
  for (GpuConfig& gpu : gpus) gpu.pass_overhead_us = 2.0;
  gpus[1].dram_bandwidth_gb_s = 30.0;
  gpus[1].rop_through_l2 = false;
  gpus[2].tile_based = true;
  gpus[2].fast_clear_color = gpus[2].fast_clear_depth = false;
  gpus[3].unit_lines_max = 200.0;
  gpus[3].registers_kib_per_core = 8.0;
  gpus[3].dram_bandwidth_gb_s = 200.0;
  gpus[3].dram_latency_cycles = 3000.0;
  gpus[4].queue_packets = 2;
  gpus[4].fast_clear_color = gpus[4].fast_clear_depth = false;
  return gpus;
}

TEST(TimeSlopes, EqualTheForwardDerivativesOfEveryKey) {
  std::size_t nonzero = 0;
  const std::vector<GpuConfig> gpus = unlike_gpus();
  for (std::size_t g = 0; g < gpus.size(); ++g)
    for (std::uint32_t seed = 1; seed < 12; ++seed)
      nonzero += expect_equal_slopes(uneven_trace(seed), gpus[g], real_keys(gpus[g]),
                                     "GPU " + std::to_string(g) + ", trace " + std::to_string(seed));
  EXPECT_GT(nonzero, 1000u);
}

TEST(TimeSlopes, OtherEnginesLeaveThemZero) {
  const GpuConfig gpu = sample_gpu();
  const std::vector<std::string> keys = real_keys(gpu);
  TimeSlopes slopes(gpu, keys);
  time_frame(uneven_trace(1), gpu, Engine::roofline, {}, &slopes);
  EXPECT_EQ(slopes.ns(), std::vector<double>(keys.size(), 0.0));
}

TEST(TimeSlopes, OfAKeyThatTheTimingDoesNotKnowIsZero) {
  const GpuConfig gpu = sample_gpu();
  const std::vector<std::string> keys = {"core_clock_mhz", "no_such_key"};
  TimeSlopes slopes(gpu, keys);
  time_frame(uneven_trace(1), gpu, Engine::queue, {}, &slopes);
  EXPECT_LT(slopes.ns()[0], 0.0);
  EXPECT_EQ(slopes.ns()[1], 0.0);
}

}  // namespace
}  // namespace hwsim::test
