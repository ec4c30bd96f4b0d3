// What a budget says of a technique: each word, at the limit and on both sides of it.
#include "lab/studies/budget.h"

#include <gtest/gtest.h>

#include "hwsim/base/diagnostics.h"

namespace hwsim::lab {
namespace {

/// 2 ms a frame, from 1.6 to 3, of which 1 ms is anti-aliasing, from 0.8 to 1.5.
Costs two_milliseconds() {
  Costs costs;
  costs.frame_ms = 2.0;
  costs.aa_ms = 1.0;
  costs.memory_mib = 100.0;
  costs.extra_mib = 40.0;
  costs.dram_mb = 500.0;
  costs.interval_ms = {1.6, 3.0};
  costs.aa_interval_ms = {0.8, 1.5};
  return costs;
}

std::string verdict_of(const std::string& budget, const Costs& costs = two_milliseconds()) {
  return std::string(verdict(costs, parse_budget(budget)));
}

TEST(Budget, LimitsAreNotNegative) {
  EXPECT_THROW(parse_budget("aa_ms<=-1"), InputError);
  EXPECT_THROW(parse_budget("frame_ms<=3, extra_mib<=-0.5"), InputError);
  EXPECT_EQ(parse_budget("extra_mib<=0").front().at_most, 0.0);
}

TEST(Budget, EveryTechniqueIsWithinNoBudget) { EXPECT_EQ(verdict_of("frame_ms<=1000"), "ok"); }

TEST(Budget, TimeIsOkWhereTheWholeIntervalIsWithinTheLimit) {
  EXPECT_EQ(verdict_of("frame_ms<=3"), "ok");
  EXPECT_EQ(verdict_of("frame_ms<=3.1"), "ok");
}

TEST(Budget, TimeIsAtRiskWhereTheLimitLiesBetweenItAndTheUpperEnd) {
  EXPECT_EQ(verdict_of("frame_ms<=2.9"), "at risk");
  EXPECT_EQ(verdict_of("frame_ms<=2"), "at risk");
}

TEST(Budget, TimeIsOverWhereItIsBeyondTheLimit) {
  EXPECT_EQ(verdict_of("frame_ms<=1.99"), "over time") << "the lower end is within";
  EXPECT_EQ(verdict_of("frame_ms<=1.5"), "over time");
}

TEST(Budget, CostOfAntiAliasingHasAnIntervalOfItsOwn) {
  EXPECT_EQ(verdict_of("aa_ms<=1.5"), "ok");
  EXPECT_EQ(verdict_of("aa_ms<=1.4"), "at risk");
  EXPECT_EQ(verdict_of("aa_ms<=1"), "at risk");
  EXPECT_EQ(verdict_of("aa_ms<=0.9"), "over time");
}

TEST(Budget, WhatCostsNothingIsNeverAtRisk) {
  Costs none = two_milliseconds();
  none.aa_ms = 0.0;
  none.aa_interval_ms = {0.0, 0.0};
  EXPECT_EQ(verdict_of("aa_ms<=0.01", none), "ok");
}

TEST(Budget, TimeWithoutAnIntervalIsUnknownAtBest) {
  Costs costs = two_milliseconds();
  costs.interval_ms.reset();
  costs.aa_interval_ms.reset();
  EXPECT_EQ(verdict_of("frame_ms<=2", costs), "unknown") << "a number that nobody checked promises nothing";
  EXPECT_EQ(verdict_of("memory_mib<=100", costs), "ok") << "memory is counted";
  EXPECT_EQ(verdict_of("frame_ms<=1.99", costs), "over time");
}

TEST(Budget, MemoryIsCountedAndHasNoInterval) {
  for (const char* within : {"memory_mib<=100", "extra_mib<=40", "dram_mb<=500"})
    EXPECT_EQ(verdict_of(within), "ok") << within;
  for (const char* beyond : {"memory_mib<=99", "extra_mib<=39", "dram_mb<=499"})
    EXPECT_EQ(verdict_of(beyond), "over memory") << beyond;
}

TEST(Budget, TheGravestWordIsSaid) {
  EXPECT_EQ(verdict_of("frame_ms<=1, memory_mib<=1"), "over memory");
  EXPECT_EQ(verdict_of("frame_ms<=2.5, aa_ms<=0.1"), "over time");
  EXPECT_EQ(verdict_of("frame_ms<=2.5, memory_mib<=100"), "at risk");
}

TEST(Budget, AnythingButQuantityAndNumberIsRefused) {
  for (const char* text :
       {"", "frame_ms", "frame_ms<3", "frame_ms<=", "frame_ms<=x", "frame_ms<=inf", "frame_ms<=nan", "ms<=3"})
    EXPECT_THROW(parse_budget(text), InputError) << text;
}

}  // namespace
}  // namespace hwsim::lab
