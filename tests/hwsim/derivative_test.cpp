// The engines over a scalar that carries derivatives: checked against finite differences.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hwsim/engines/sensitivity.h"
#include "hwsim/gpu/gpu_keys.h"
#include "hwsim/gpu/gpu_rules.h"
#include "hwsim/sample_gpu.h"

namespace hwsim::test {
namespace {

WorkTrace busy_trace() {
  WorkTrace trace;
  trace.passes = {busy_pass(70), fill_pass(Format::rgba16_float, true, 4096, 3)};
  trace.passes[1].barrier_before = true;
  return trace;
}

GpuConfig busy_gpu() {
  GpuConfig gpu = sample_gpu();
  gpu.dram_bandwidth_gb_s = 60.0;
  gpu.pass_overhead_us = 2.0;
  return gpu;
}

double& slot_of(GpuConfig& gpu, const std::vector<Key>& keys, std::string_view name) {
  (void)gpu;  // the keys point into it
  return *std::get<double*>(
      std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return key.info.name == name; })->slot);
}

TEST(Derivative, OfEveryRealKeyEqualsTheFiniteDifference) {
  GpuConfig gpu = busy_gpu();
  const std::vector<Key> keys = keys_of(static_cast<GpuValues<double>&>(gpu));
  const WorkTrace trace = busy_trace();
  std::size_t nonzero = 0;
  for (const Engine engine : {Engine::roofline, Engine::queue}) {
    const std::vector<Sensitivity> all = sensitivities(trace, gpu, engine);
    EXPECT_EQ(all.size(),
              static_cast<std::size_t>(std::count_if(keys.begin(), keys.end(), [&](const Key& key) {
                return std::holds_alternative<double*>(key.slot) && applies(key.info.name, gpu);
              })));
    const double frame_ns = time_frame(trace, gpu, engine).time_ns;
    for (const Sensitivity& s : all) {
      double& slot = slot_of(gpu, keys, s.key);
      const double value = slot, step = std::max(1e-6, 1e-6 * std::abs(value));
      const auto time_at = [&](double x) {
        slot = x;
        return time_frame(trace, gpu, engine).time_ns;
      };
      const double above = (time_at(value + step) - frame_ns) / step;
      const double below = (frame_ns - time_at(value - step)) / step;
      slot = value;
      // At a kink the derivative is that of one side.
      const double error = std::min(std::abs(s.slope_ns - above), std::abs(s.slope_ns - below));
      EXPECT_LE(error, 2e-3 * std::max(std::abs(above), std::abs(below)) + 5e-2)
          << s.key << " in " << engine_name(engine) << ": " << s.slope_ns << ", " << below << " to " << above;
      EXPECT_DOUBLE_EQ(s.elasticity, s.slope_ns * value / frame_ns) << s.key;
      nonzero += s.slope_ns != 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(nonzero, 20u);
}

TEST(Sensitivity, NumbersOfAnotherKindOfGpuAreNotOffered) {
  const auto offered = [](const GpuConfig& gpu, std::string_view start) {
    std::size_t count = 0;
    for (const Engine engine : {Engine::roofline, Engine::queue})
      for (const Sensitivity& s : sensitivities(busy_trace(), gpu, engine)) count += s.key.starts_with(start);
    return count;
  };
  GpuConfig gpu = busy_gpu();
  gpu.vliw_slots = gpu.vliw_fill_slots = 1.0;
  gpu.tile_based = false;
  EXPECT_EQ(offered(gpu, "vliw_"), 0u);
  EXPECT_EQ(offered(gpu, "tile_"), 0u);
  gpu.vliw_slots = 5.0;
  gpu.vliw_fill_slots = 3.4;
  EXPECT_EQ(offered(gpu, "vliw_"), 2u * 3u);
  gpu.tile_based = true;
  EXPECT_EQ(offered(gpu, "tile_"), 2u * 2u);
}

TEST(Sensitivity, TwiceAValueIsTimedWhereTheRulesAllowIt) {
  GpuConfig gpu = busy_gpu();
  gpu.vliw_slots = 5.0;
  gpu.vliw_fill_slots = 3.4;
  gpu.tex_128bit_ratio = 0.4;
  gpu.tex_64bit_ratio = 0.5;
  for (const Sensitivity& s : sensitivities(busy_trace(), gpu, Engine::queue)) {
    const bool is_none = s.key == "vliw_fill_slots" || s.key == "tex_128bit_ratio";
    const bool is_gpu = s.key == "core_clock_mhz" || s.key == "tex_64bit_ratio";
    if (is_none || is_gpu) {
      EXPECT_EQ(s.doubled_ns.has_value(), is_gpu) << s.key;
    }
  }
}

// Time is homogeneous: with every clock and bandwidth doubled and every fixed cost halved it halves.
TEST(Derivative, OfRatesSumsToMinusOne) {
  GpuConfig gpu = busy_gpu();
  double sum = 0.0;
  for (const Sensitivity& s : sensitivities(busy_trace(), gpu, Engine::queue)) {
    if (s.key == "core_clock_mhz" || s.key == "dram_bandwidth_gb_s") sum += s.elasticity;
    if (s.key == "pass_overhead_us" || s.key == "dram_turn_ns") sum -= s.elasticity;
  }
  EXPECT_NEAR(sum, -1.0, 1e-9);
}

TEST(Headroom, TakingAUnitAwayNeverSlowsAndTheLimiterGainsMost) {
  const GpuConfig gpu = busy_gpu();
  const WorkTrace trace = busy_trace();
  for (const Engine engine : {Engine::roofline, Engine::queue}) {
    const double frame_ns = time_frame(trace, gpu, engine).time_ns;
    const std::vector<UnitHeadroom> units = headroom(trace, gpu, engine);
    ASSERT_GT(units.size(), 5u);
    for (const UnitHeadroom& unit : units) EXPECT_LE(unit.time_ns, frame_ns) << unit_name(unit.unit);
    EXPECT_LT(units.front().time_ns, frame_ns);
  }
}

TEST(Headroom, OfTheOnlyUnitIsTheWholeTimeButTheFixedCost) {
  GpuConfig gpu = busy_gpu();
  WorkTrace trace;
  PassCounters c;
  c.stats.input_assembly_vertices = 1000;
  trace.passes = {repeated(PassKind::draw, c, 4)};
  const std::vector<UnitHeadroom> units = headroom(trace, gpu, Engine::queue);
  ASSERT_EQ(units.size(), 1u);
  EXPECT_EQ(units[0].unit, Unit::ia);
  EXPECT_DOUBLE_EQ(units[0].time_ns, gpu.pass_overhead_us * 1000.0);
}

}  // namespace
}  // namespace hwsim::test
