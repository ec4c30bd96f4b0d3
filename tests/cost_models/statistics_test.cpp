#include "cost_models/statistics.h"

#include <gtest/gtest.h>

namespace hwsim::cost_models::test {
namespace {

TEST(Statistics, MeanMedianAndErrors) {
  const std::vector<double> values = {4.0, 1.0, 3.0, 2.0};
  EXPECT_DOUBLE_EQ(mean(values), 2.5);
  EXPECT_DOUBLE_EQ(median(values), 2.5);
  EXPECT_DOUBLE_EQ(median({5.0, 1.0, 9.0}), 5.0);
  EXPECT_DOUBLE_EQ(percent_error(9.0, 10.0), 10.0);
}

// ceil((n + 1) 0.9): the 9th of 9, the 18th of 19.
TEST(Statistics, ConformalQuantileCountsOneUnseenValue) {
  std::vector<double> values;
  for (int i = 1; i <= 9; ++i) values.push_back(i);
  EXPECT_DOUBLE_EQ(conformal_quantile(values, 0.9), 9.0);
  for (int i = 10; i <= 19; ++i) values.push_back(i);
  EXPECT_DOUBLE_EQ(conformal_quantile(values, 0.9), 18.0);
  EXPECT_DOUBLE_EQ(conformal_quantile({3.0}, 0.9), 3.0);
}

// By hand: of the three pairs of group a two agree; b has one pair, published equal, which does not count.
TEST(Statistics, KendallComparesInsideGroups) {
  const std::vector<Ranked> values = {
      {"a", 1.0, 1.0}, {"a", 3.0, 2.0}, {"a", 2.0, 3.0}, {"b", 1.0, 5.0}, {"b", 2.0, 5.0}};
  EXPECT_NEAR(kendall(values), (2.0 - 1.0) / 3.0, 1e-12);
}

TEST(Statistics, RegressionFindsALine) {
  const std::vector<std::vector<double>> x = {{1.0, 0.0}, {0.0, 1.0}, {2.0, 1.0}, {1.0, 3.0}};
  const std::vector<double> y = {5.0, 7.0, 11.0, 17.0};
  const std::vector<double> line = linear_regression(x, y);
  ASSERT_EQ(line.size(), 3u);
  EXPECT_NEAR(line[0], 2.0, 1e-12);
  EXPECT_NEAR(line[1], 4.0, 1e-12);
  EXPECT_NEAR(line[2], 3.0, 1e-12);
}

TEST(Statistics, AFoldsQuantileComesFromTheOthers) {
  const std::vector<std::string> folds = {"a", "a", "b", "b"};
  const std::vector<double> values = {1.0, 2.0, 10.0, 20.0};
  const auto quantiles = quantiles_without(folds, values, 0.9);
  EXPECT_EQ(quantiles.at("a"), 20.0);
  EXPECT_EQ(quantiles.at("b"), 2.0);
  EXPECT_EQ(quantiles_without(std::vector<std::string>{"a"}, std::vector<double>{3.0}, 0.9).at("a"), 3.0);
}

}  // namespace
}  // namespace hwsim::cost_models::test
