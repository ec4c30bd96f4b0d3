// The Pareto front of time and error, on numbers that a reader can judge by eye.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lab/studies/ranking.h"

namespace hwsim::lab {
namespace {

RankedTechnique technique(double frame_ms, double flip_mean, std::string reason = {}) {
  RankedTechnique t;
  t.frame_ms = frame_ms;
  t.flip_mean = flip_mean;
  t.reason = std::move(reason);
  return t;
}

std::vector<bool> front(std::vector<RankedTechnique> techniques) {
  mark_pareto(techniques);
  std::vector<bool> marks;
  for (const RankedTechnique& t : techniques) marks.push_back(t.pareto);
  return marks;
}

TEST(ParetoFront, HoldsWhatNobodyBeatsInTimeAndError) {
  EXPECT_EQ(front({technique(1.0, 0.30), technique(2.0, 0.10), technique(2.5, 0.20), technique(4.0, 0.05)}),
            (std::vector{true, true, false, true}));
}

TEST(ParetoFront, EqualsDoNotBeatEachOther) {
  EXPECT_EQ(front({technique(1.0, 0.1), technique(1.0, 0.1)}), (std::vector{true, true}));
}

TEST(ParetoFront, AnAdvantageInOneIsEnoughWhereTheOtherIsEqual) {
  EXPECT_EQ(front({technique(1.0, 0.1), technique(1.0, 0.2)}), (std::vector{true, false}));
  EXPECT_EQ(front({technique(1.0, 0.1), technique(2.0, 0.1)}), (std::vector{true, false}));
}

TEST(ParetoFront, WhatCannotRunNeitherStandsOnItNorPushesOthersOff) {
  EXPECT_EQ(front({technique(0.0, 0.0, "the GPU lacks a feature"), technique(1.0, 0.1)}),
            (std::vector{false, true}));
}

}  // namespace
}  // namespace hwsim::lab
