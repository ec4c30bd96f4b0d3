// The points that axes span: grids, zipped lists and Latin hypercubes.
#include "lab/studies/axes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "hwsim/base/diagnostics.h"

namespace hwsim::lab {
namespace {

using Points = std::vector<std::vector<Assignment>>;

Points all(const PointSettings& settings) {
  Points points;
  for (std::size_t i = 0; i < settings.size(); ++i) points.push_back(settings[i]);
  return points;
}

double number(const Assignment& set) { return std::stod(set.value); }

TEST(Axes, TheLastAxisVariesFastestInAGrid) {
  const Points points = all({parse_axes({"gpu.a=1,2", "gpu.b=x,y,z"}), Combine::grid});
  std::vector<std::string> texts;
  for (const auto& point : points) texts.push_back(point[0].value + point[1].value);
  EXPECT_EQ(texts, (std::vector<std::string>{"1x", "1y", "1z", "2x", "2y", "2z"}));
}

TEST(Axes, ZippedListsGoTogetherAndMustBeOfOneLength) {
  const Points points = all({parse_axes({"gpu.a=1,2", "gpu.b=x,y"}), Combine::zip});
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[1][0].value + points[1][1].value, "2y");
  EXPECT_THROW(PointSettings(parse_axes({"gpu.a=1,2", "gpu.b=x"}), Combine::zip), InputError);
}

TEST(Axes, NoneSpanOnePointWithoutSettings) {
  for (const Points& points : {all({std::vector<Axis>{}, Combine::grid}), all({})}) {
    ASSERT_EQ(points.size(), 1u);
    EXPECT_TRUE(points[0].empty());
  }
}

TEST(Axes, WordsAreWholeAndNoRanges) {
  EXPECT_EQ(parse_axis("resolution=640x360,1280x720").values,
            (std::vector<std::string>{"640x360", "1280x720"}));
  EXPECT_EQ(parse_axis("scene=../a..b.glb,grass:seed=3,blades=10,car_body").values,
            (std::vector<std::string>{"../a..b.glb", "grass:seed=3,blades=10", "car_body"}));
  EXPECT_EQ(parse_axis("overlay=none,l2-x4+rops-x2").values,
            (std::vector<std::string>{"none", "l2-x4+rops-x2"}));
  for (const char* wrong : {"gpu=", "camera=0,,1", "gpus=a", "resolution"})
    EXPECT_THROW(parse_axis(wrong), InputError) << wrong;
}

TEST(Axes, LogarithmicRangesHaveEqualRatios) {
  const Axis axis = parse_axis("gpu.l2_size_kib=256..4096:5:log");
  EXPECT_EQ(axis.values, (std::vector<std::string>{"256", "512", "1024", "2048", "4096"}));
}

TEST(Axes, WhatCountsThingsHasWholeNumbers) {
  const auto values = [](const char* text) { return parse_axis(text).values; };
  using Values = std::vector<std::string>;
  EXPECT_EQ(values("gpu.rops=16..128:5:log"), (Values{"16", "27", "45", "76", "128"}));
  EXPECT_EQ(values("gpu.crop_units=16..128:4"), (Values{"16", "53", "91", "128"}));
  EXPECT_EQ(values("gpu.features.native_msaa_max=1..8:5:log"), (Values{"1", "2", "3", "5", "8"}));
  EXPECT_EQ(values("scene.point_lights=0..3:3"), (Values{"0", "2", "3"}));
  EXPECT_EQ(values("technique.list_cap=1..4:5:log"), (Values{"1", "2", "3", "4"})) << "2 came twice";
  EXPECT_EQ(values("gpu.rops=1..3:9"), (Values{"1", "2", "3"}));
  for (const char* real : {"gpu.core_clock_mhz", "gpu.infinity_cache", "scene.light_range", "technique.k"})
    EXPECT_EQ(values((std::string(real) + "=1..2:3").c_str()), (Values{"1", "1.5", "2"})) << real;
  EXPECT_EQ(values("gpu.no_such_key=1..2:3"), (Values{"1", "1.5", "2"})) << "told by what reads it";
}

TEST(LatinHypercube, TakesWholeNumbersOfWhatCountsThings) {
  const Points points = all({parse_axes({"gpu.rops=16..128", "gpu.core_clock_mhz=500..1500"}), 40, 1});
  std::set<std::string> clocks;
  for (const auto& point : points) {
    EXPECT_EQ(point[0].value.find_first_not_of("0123456789."), std::string::npos) << point[0].value;
    EXPECT_EQ(number(point[0]), std::round(number(point[0])));
    EXPECT_TRUE(number(point[0]) >= 16 && number(point[0]) <= 128);
    clocks.insert(point[1].value);
  }
  EXPECT_EQ(clocks.size(), points.size());
}

TEST(LatinHypercube, UsesEachStratumOfEachRangeOnce) {
  constexpr int kPoints = 64;
  const std::vector<Axis> axes = parse_axes({"gpu.a=2..10", "gpu.b=1..1024:2:log"});
  for (const std::uint64_t seed : {1u, 2u, 12345u}) {
    const Points points = all({axes, kPoints, seed});
    ASSERT_EQ(points.size(), std::size_t{kPoints});
    std::set<int> linear, logarithmic;
    for (const auto& point : points) {
      ASSERT_EQ(point.size(), 2u);
      linear.insert(static_cast<int>((number(point[0]) - 2.0) / 8.0 * kPoints));
      logarithmic.insert(static_cast<int>(std::log2(number(point[1])) / 10.0 * kPoints));
    }
    for (const std::set<int>& strata : {linear, logarithmic}) {
      EXPECT_EQ(strata.size(), std::size_t{kPoints}) << "seed " << seed;
      EXPECT_EQ(*strata.begin(), 0);
      EXPECT_EQ(*strata.rbegin(), kPoints - 1);
    }
  }
}

TEST(LatinHypercube, TakesEachValueOfAListEquallyOften) {
  const Points points = all({parse_axes({"gpu.a=x,y,z"}), 12, 7});
  std::map<std::string, int> count;
  for (const auto& point : points) ++count[point[0].value];
  EXPECT_EQ(count, (std::map<std::string, int>{{"x", 4}, {"y", 4}, {"z", 4}}));
}

TEST(LatinHypercube, FollowsItsSeed) {
  const std::vector<Axis> axes = parse_axes({"gpu.a=0..1", "gpu.b=0..1"});
  const auto text = [&](std::uint64_t seed) {
    std::string joined;
    for (const auto& point : all({axes, 8, seed}))
      for (const Assignment& set : point) joined += set.value + " ";
    return joined;
  };
  EXPECT_EQ(text(1), text(1));
  EXPECT_NE(text(1), text(2));
}

TEST(LatinHypercube, ShufflesTheAxesIndependently) {
  const Points points = all({parse_axes({"gpu.a=0..1", "gpu.b=0..1"}), 32, 1});
  int same = 0;
  for (const auto& point : points)
    same += static_cast<int>(number(point[0]) * 32) == static_cast<int>(number(point[1]) * 32);
  EXPECT_LT(same, 16) << "the points do not lie on the diagonal";
}

}  // namespace
}  // namespace hwsim::lab
