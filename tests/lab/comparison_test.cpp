// Comparisons of results made by hand: passes by name, changes by their baseline.
#include "lab/studies/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hwsim::lab {
namespace {

PassResult pass(const std::string& name, double time_ms, double depth_bytes, std::uint64_t fragments) {
  return {.name = name,
          .time_ms = time_ms,
          .limiter = "crop",
          .bytes = {{"depth", depth_bytes}},
          .counters = {{"raster.fragments", fragments}, {"raster.quads", 7}}};
}

Result result(std::vector<PassResult> passes) {
  Result result{.scene = "s", .technique = "t", .gpu = "g"};
  for (const PassResult& pass : passes) result.frame.time_ms += pass.time_ms;
  result.passes = std::move(passes);
  return result;
}

std::vector<std::string> names(const Difference& difference) {
  std::vector<std::string> found;
  for (const PassDifference& pass : difference.passes) found.push_back(pass.name);
  return found;
}

TEST(Comparison, ChangeIsRelativeToTheBaselineAndNoneFromNothing) {
  EXPECT_EQ(relative_change(2.0, 3.0), 0.5);
  EXPECT_EQ(relative_change(-2.0, -3.0), -0.5);
  EXPECT_EQ(relative_change(0.0, 0.0), 0.0);
  EXPECT_EQ(relative_change(0.0, 1.0), std::nullopt);
}

TEST(Comparison, PassesAreMatchedByNameAndNewOnesStandWhereTheyRun) {
  const Comparison comparison = compare(
      {{"a", result({pass("clear", 1, 10, 1), pass("draw", 2, 20, 2), pass("old", 1, 5, 5)}), ""},
       {"b", result({pass("clear", 1, 10, 1), pass("resolve", 4, 8, 3), pass("draw", 3, 25, 9)}), ""}},
      nullptr);
  const Difference& difference = comparison.differences.front();
  EXPECT_EQ(names(difference), (std::vector<std::string>{"clear", "resolve", "draw", "old"}));
  const PassDifference& fresh = difference.passes[1];
  EXPECT_FALSE(fresh.limiter.before);
  EXPECT_EQ(fresh.limiter.after, "crop");
  EXPECT_EQ(fresh.time_ms.before, 0.0);
  EXPECT_EQ(fresh.dram_mb.after, 8e-6);
  const PassDifference& gone = difference.passes[3];
  EXPECT_EQ(gone.limiter.before, "crop");
  EXPECT_FALSE(gone.limiter.after);
  EXPECT_EQ(gone.bytes.front().second.before, 5.0) << "bytes of a pass that only the baseline has";
}

TEST(Comparison, CountersThatStayAreLeftOut) {
  const Comparison comparison = compare(
      {{"a", result({pass("draw", 2, 20, 2)}), ""}, {"b", result({pass("draw", 2, 20, 9)}), ""}}, nullptr);
  const PassDifference& draw = comparison.differences.front().passes.front();
  ASSERT_EQ(draw.counters.size(), 1u);
  EXPECT_EQ(draw.counters.front().first, "raster.fragments");
  EXPECT_EQ(draw.counters.front().second.before, 2u);
  EXPECT_EQ(draw.counters.front().second.after, 9u);
}

TEST(Comparison, SlowestPassOfEachResultIsNamed) {
  const Comparison comparison = compare(
      {{"a", result({pass("clear", 1, 0, 0), pass("draw", 2, 0, 0)}), ""}, {"b", result({}), ""}}, nullptr);
  const Table table = frame_comparison(comparison);
  EXPECT_EQ(std::get<std::string>(table.rows[0][7]), "crop in draw");
  EXPECT_EQ(std::get<std::string>(table.rows[1][7]), "n/a");
}

/// A result of `time_ms` on a calibrated GPU, all of whose time is one unit's.
LabeledResult timed(const std::string& technique, const std::string& variation, double time_ms,
                    const std::string& unit) {
  Result r{.scene = "s", .technique = technique, .gpu = "g"};
  r.frame.time_ms = time_ms;
  r.frame.support = "calibrated";
  r.frame.interval_ms = {0.5 * time_ms, 2.0 * time_ms};
  r.frame.error_sources = {{{"g.alu_efficiency_ratio", unit == "shader" ? -1.0 : 0.0}}, {{unit, 1.0}}};
  return {technique + variation, r, variation};
}

/// One parameter known to 10 %; the model errs by 20 %, ratios of techniques by 30 %.
cost_models::Calibration calibration() {
  cost_models::Calibration c;
  c.parameters.resize(1);
  c.parameters[0].member = "g";
  c.parameters[0].name = "alu_efficiency_ratio";
  c.covariance = {0.01};
  c.residual_log_sd = 0.2;
  c.ratio_log_sd = 0.3;
  c.quantile90 = {{"leave_scene_out", 4.0}};
  c.ratio_quantile90 = {{"leave_scene_out", 2.0}};
  return c;
}

double half_width(const Difference& d) {
  return 0.5 * std::log(((*d.time_change_interval)[1] + 1.0) / ((*d.time_change_interval)[0] + 1.0));
}

TEST(Comparison, EachTechniqueIsHeldAgainstItself) {
  const cost_models::Calibration c = calibration();
  const Comparison comparison = compare({timed("a", "", 1, "dram"), timed("b", "", 2, "dram"),
                                         timed("a", "x2", 0.5, "dram"), timed("b", "x2", 1.9, "dram")},
                                        &c);
  ASSERT_EQ(comparison.differences.size(), 3u);
  EXPECT_EQ(comparison.differences[0].base, "a");
  EXPECT_EQ(comparison.differences[1].base, "a");
  EXPECT_EQ(comparison.differences[2].base, "b");
  EXPECT_EQ(comparison.differences[2].time_ms.before, 2.0);
  const Table matrix = variation_matrix(comparison);
  ASSERT_EQ(matrix.rows.size(), 2u);
  EXPECT_EQ(matrix.columns.back().title, "x2");
  EXPECT_EQ(std::get<std::string>(matrix.rows[0].back()), "-50.0 % [-50.0, -50.0]");
  EXPECT_EQ(std::get<std::string>(matrix.rows[1].back()), "-5.0 % [-5.0, -5.0]");
}

TEST(Comparison, WhatBothResultsHaveInCommonCancels) {
  const cost_models::Calibration c = calibration();
  const Comparison comparison =
      compare({timed("a", "", 1, "dram"), timed("a", "same", 2, "dram"), timed("a", "moved", 2, "shader"),
               timed("b", "", 2, "dram"), timed("b", "moved", 2, "shader")},
              &c);
  EXPECT_NEAR(half_width(comparison.differences[0]), 0.0, 1e-12) << "the same unit holds all of the time";
  EXPECT_NEAR(half_width(comparison.differences[1]), 2.0 * std::sqrt(0.01 + 2.0 * 0.04), 1e-12);
  EXPECT_NEAR(half_width(comparison.differences[2]), 2.0 * 0.3, 1e-12) << "another technique";
  EXPECT_NEAR(half_width(comparison.differences[3]), 2.0 * std::sqrt(0.01 + 2.0 * 0.04), 1e-12);
}

TEST(Comparison, OtherScenesAndGpusKeepBothErrors) {
  const cost_models::Calibration c = calibration();
  std::vector<LabeledResult> results = {timed("a", "", 1, "dram"), timed("a", "", 1, "dram"),
                                        timed("a", "", 1, "dram")};
  results[1].result.scene = "other";
  results[2].result.frame.interval_ms.reset();
  const Comparison comparison = compare(results, &c);
  EXPECT_NEAR(half_width(comparison.differences[0]), 4.0 * std::sqrt(2.0 * 0.04), 1e-12);
  EXPECT_FALSE(comparison.differences[1].time_change_interval) << "a time without an interval";
  EXPECT_FALSE(compare(results, nullptr).differences[0].time_change_interval);
}

TEST(Comparison, PassesThatStayAreLeftOutUnlessAskedFor) {
  const Comparison comparison =
      compare({{"a", result({pass("clear", 1, 10, 1), pass("draw", 2, 20, 2)}), ""},
               {"b", result({pass("clear", 1, 10, 1), pass("draw", 3, 20, 2)}), ""}},
              nullptr);
  EXPECT_EQ(pass_comparison(comparison).rows.size(), 1u);
  EXPECT_EQ(pass_comparison(comparison, true).rows.size(), 2u);
}

TEST(TimeDirection, IsThatOfAllKeysThatChange) {
  GpuConfig gpu;
  gpu.dram_bandwidth_gb_s = 100.0;
  const auto direction = [&](const auto& change) {
    GpuConfig changed = gpu;
    change(changed);
    return time_direction(gpu, changed);
  };
  EXPECT_EQ(direction([](GpuConfig&) {}), 0);
  EXPECT_EQ(direction([](GpuConfig& g) { g.dram_bandwidth_gb_s *= 2; }), -1);
  EXPECT_EQ(direction([](GpuConfig& g) { g.dram_bandwidth_gb_s *= 0.5; }), 1);
  EXPECT_EQ(direction([](GpuConfig& g) { g.pass_overhead_us += 1; }), 1) << "a larger value is slower";
  EXPECT_EQ(direction([](GpuConfig& g) { g.dram_bandwidth_gb_s *= 2, g.pass_overhead_us += 1; }), 0);
  EXPECT_EQ(direction([](GpuConfig& g) { g.features.native_msaa_max *= 2, g.dram_bandwidth_gb_s *= 2; }), 0)
      << "another frame is drawn";
}

}  // namespace
}  // namespace hwsim::lab
