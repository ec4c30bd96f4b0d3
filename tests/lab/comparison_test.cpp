// Comparisons of results made by hand: passes by name, changes by their baseline.
#include "lab/studies/comparison.h"

#include <gtest/gtest.h>

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
  const Comparison comparison =
      compare({{"a", result({pass("clear", 1, 10, 1), pass("draw", 2, 20, 2), pass("old", 1, 5, 5)})},
               {"b", result({pass("clear", 1, 10, 1), pass("resolve", 4, 8, 3), pass("draw", 3, 25, 9)})}});
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
  const Comparison comparison =
      compare({{"a", result({pass("draw", 2, 20, 2)})}, {"b", result({pass("draw", 2, 20, 9)})}});
  const PassDifference& draw = comparison.differences.front().passes.front();
  ASSERT_EQ(draw.counters.size(), 1u);
  EXPECT_EQ(draw.counters.front().first, "raster.fragments");
  EXPECT_EQ(draw.counters.front().second.before, 2u);
  EXPECT_EQ(draw.counters.front().second.after, 9u);
}

TEST(Comparison, SlowestPassOfEachResultIsNamed) {
  const Comparison comparison =
      compare({{"a", result({pass("clear", 1, 0, 0), pass("draw", 2, 0, 0)})}, {"b", result({})}});
  const Table table = frame_comparison(comparison);
  EXPECT_EQ(std::get<std::string>(table.rows[0][5]), "crop in draw");
  EXPECT_EQ(std::get<std::string>(table.rows[1][5]), "n/a");
}

}  // namespace
}  // namespace hwsim::lab
