// Where partly covered pixels take their attributes (docs/techniques/conventions.md#rasterization).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "pipeline/state/sample_pattern.h"

namespace hwsim::pipeline {
namespace {

constexpr int kCounts[] = {2, 4, 8, 16, 32};

std::size_t at(const CentroidRule& rule, std::size_t place) {
  return rule.order.empty() ? place : rule.order[place];
}

TEST(Centroid, OrderGoesFromTheCenterOutward) {
  for (const int samples : kCounts) {
    const CentroidRule rule = standard_centroid(samples);
    std::uint32_t seen = 0;
    int last = 0;
    for (std::size_t i = 0; i < rule.positions.size(); ++i) {
      const SamplePosition p = rule.positions[at(rule, i)];
      const int distance = p.x * p.x + p.y * p.y;
      EXPECT_GE(distance, last) << samples << " samples, place " << i;
      last = distance;
      seen |= 1u << at(rule, i);
    }
    EXPECT_EQ(seen, samples == 32 ? ~0u : (1u << samples) - 1) << "each sample has one place";
  }
}

// Over edges of all directions and places the attribute location is the center in the mean: where it is not,
// textures move against the picture. Layer by layer, the mean of 32 samples lay 0.29 of a pixel up and left.
// The standard patterns of 4 and 8 samples have 0.17 and 0.10 by their own order.
TEST(Centroid, LiesAtTheCenterInTheMeanOverEdges) {
  for (const int samples : {2, 16, 32}) {
    const CentroidRule rule = standard_centroid(samples);
    double x = 0.0, y = 0.0;
    int partly = 0;
    for (int direction = 0; direction < 360; ++direction)
      for (int offset = -11; offset <= 11; ++offset) {
        const double angle = direction * 3.14159265358979 / 180.0;
        std::size_t covered = 0, first = rule.positions.size();
        for (std::size_t i = 0; i < rule.positions.size(); ++i) {
          const SamplePosition p = rule.positions[at(rule, i)];
          if (p.x * std::cos(angle) + p.y * std::sin(angle) < offset + 0.5) continue;
          ++covered;
          if (first == rule.positions.size()) first = at(rule, i);
        }
        if (covered == 0 || covered == rule.positions.size()) continue;
        ++partly;
        x += rule.positions[first].x;
        y += rule.positions[first].y;
      }
    ASSERT_GT(partly, 0);
    EXPECT_LT(std::hypot(x, y) / partly, 0.6) << samples << " samples, sixteenths of a pixel";
  }
}

}  // namespace
}  // namespace hwsim::pipeline
