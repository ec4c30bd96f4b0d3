// The fit against a truth that is known, and under data that no fit should be led astray by.
#include "cost_models/fit.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "cost_models/synthetic.h"

namespace hwsim::cost_models::test {
namespace {

// Central differences of every residual by every parameter.
TEST(Predictor, JetsEqualCentralDifferences) {
  const Synthetic s = make_synthetic(2, 2);
  const Experiment& e = s.experiment;
  Predictor exact(e, 1), shifted(e, 1);
  exact.evaluate(s.truth, true);
  constexpr double kStep = 1e-6;
  std::size_t nonzero = 0;
  for (std::size_t k = 0; k < e.parameters.size(); ++k) {
    std::vector<double> up = s.truth, down = s.truth;
    up[k] += kStep;
    down[k] -= kStep;
    shifted.evaluate(up, false);
    std::vector<double> high;
    for (std::size_t i = 0; i < e.cells.size(); ++i) high.push_back(std::log(shifted[i].ms));
    shifted.evaluate(down, false);
    for (std::size_t i = 0; i < e.cells.size(); ++i) {
      const double slope = (high[i] - std::log(shifted[i].ms)) / (2.0 * kStep);
      EXPECT_NEAR(exact[i].gradient[k], slope, 1e-5) << e.parameters[k].id() << ", cell " << i;
      if (exact[i].gradient[k] != 0.0) ++nonzero;
    }
  }
  EXPECT_GT(nonzero, e.cells.size());
}

TEST(Predictor, ThreadsDoNotChangeBits) {
  const Synthetic s = make_synthetic(2, 2);
  Predictor one(s.experiment, 1), three(s.experiment, 3);
  one.evaluate(s.truth, true);
  three.evaluate(s.truth, true);
  for (std::size_t i = 0; i < s.experiment.cells.size(); ++i) {
    EXPECT_EQ(one[i].ms, three[i].ms);
    EXPECT_EQ(one[i].gradient, three[i].gradient);
  }
}

TEST(Fit, FindsTheTruthFromTheDeclaredStart) {
  Synthetic s = make_synthetic();
  forget_priors(s.experiment);
  const Fit f = fit_all(s.experiment);
  EXPECT_TRUE(f.converged) << f.message;
  const std::vector<double> ms = predictions(s.experiment, f);
  for (std::size_t i = 0; i < ms.size(); ++i)
    EXPECT_NEAR(ms[i] / s.experiment.cells[i].published, 1.0, 1e-3) << i;
  for (std::size_t k = 0; k < s.truth.size(); ++k)
    if (f.estimates[k].identified && !f.estimates[k].at_bound) {
      EXPECT_NEAR(f.log_values[k], s.truth[k], 0.01) << s.experiment.parameters[k].id();
    }
}

TEST(Fit, IsDeterministic) {
  const Synthetic s = make_synthetic(2, 3);
  EXPECT_EQ(fit_all(s.experiment, 2).log_values, fit_all(s.experiment, 2).log_values);
}

TEST(Fit, RandomStartsSayWhetherTheyEndTogether) {
  const Synthetic s = make_synthetic(2, 4);
  const Fit f = fit_all(s.experiment, 5);
  ASSERT_EQ(f.starts.size(), 5u);
  for (const StartOutcome& outcome : f.starts)
    EXPECT_EQ(outcome.same_optimum, outcome.cost <= f.cost * 1.001 + 1e-9);
  EXPECT_TRUE(std::any_of(f.starts.begin(), f.starts.end(), [](const auto& o) { return o.same_optimum; }));
}

// One row of 60 printed 100 times too large.
TEST(Fit, OneCorruptedRowMovesTheOthersLittle) {
  Synthetic s = make_synthetic();
  add_noise(s.experiment, 3.0);
  const std::vector<double> before = predictions(s.experiment, fit_all(s.experiment));
  s.experiment.cells[10].published *= 100.0;
  const Fit f = fit_all(s.experiment);
  const std::vector<double> after = predictions(s.experiment, f);
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (i == 10) continue;
    EXPECT_NEAR(after[i] / before[i], 1.0, 0.02) << i;
  }
}

TEST(Fit, TimesAThousandTimesLargerOrSmallerEndAtBoundsThatAreNamed) {
  for (const double factor : {1e-3, 1e3}) {
    Synthetic s = make_synthetic(2, 3);
    for (Cell& cell : s.experiment.cells) cell.published *= factor;
    const Fit f = fit_all(s.experiment);
    EXPECT_TRUE(
        std::any_of(f.estimates.begin(), f.estimates.end(), [](const Estimate& e) { return e.at_bound; }));
    for (const double value : f.log_values) EXPECT_TRUE(std::isfinite(value));
    for (const double value : f.covariance) EXPECT_TRUE(std::isfinite(value));
  }
}

// Numbers that are much too fast never limit anything, so nothing but range and prior can bring them back.
TEST(Fit, StartsAThousandfoldOffAreRecovered) {
  const Synthetic s = make_synthetic(3, 4);
  std::vector<double> start = s.truth;
  for (std::size_t k = 0; k < start.size(); ++k) start[k] += (k % 2 == 0 ? 1.0 : -1.0) * std::log(999.0);
  FitOptions options;
  options.max_iterations = 400;
  const Fit f = fit(s.experiment, fitted_cells(s.experiment), start, options);
  const std::vector<double> ms = predictions(s.experiment, f);
  std::size_t close = 0;
  for (std::size_t i = 0; i < ms.size(); ++i)
    if (std::abs(ms[i] / s.experiment.cells[i].published - 1.0) < 0.05) ++close;
  EXPECT_GT(close, ms.size() * 9 / 10);
}

TEST(Fit, RowsPrintedTwiceChangeOnlyTheirWeight) {
  Synthetic s = make_synthetic(2, 3);
  forget_priors(s.experiment);
  const Fit once = fit_all(s.experiment);
  const std::size_t rows = s.experiment.cells.size();
  for (Replay& replay : s.experiment.replays) {
    const std::vector<std::size_t> cells = replay.cells;
    for (const std::size_t cell : cells) {
      replay.cells.push_back(s.experiment.cells.size());
      s.experiment.cells.push_back(s.experiment.cells[cell]);
    }
  }
  const Fit twice = fit_all(s.experiment);
  EXPECT_EQ(twice.fitted_values, 2 * rows);
  const std::vector<double> a = predictions(s.experiment, once), b = predictions(s.experiment, twice);
  for (std::size_t i = 0; i < rows; ++i) EXPECT_NEAR(b[i] / a[i], 1.0, 1e-3);
}

TEST(Fit, AParameterThatNothingDeterminesIsNamed) {
  Synthetic s = make_synthetic(2, 3);
  s.experiment.parameters.push_back(parameter(Scope::gpu, "a", "atomic_lane_ops_per_clk", 64.0, 1.0, 200.0));
  s.truth.push_back(std::log(64.0));
  const Fit f = fit_all(s.experiment);
  EXPECT_FALSE(f.estimates.back().identified);
  EXPECT_TRUE(f.estimates.front().identified);
}

TEST(Fit, ProductsOfParametersAreReportedAsCorrelated) {
  Synthetic s = make_synthetic(2, 3);
  add_noise(s.experiment, 2.0);
  s.experiment.parameters.push_back(parameter(Scope::gpu, "a", "dram_bandwidth_gb_s", 60.0, 10.0, 200.0));
  const Fit f = fit_all(s.experiment);
  const std::size_t added = s.experiment.parameters.size() - 1;
  EXPECT_TRUE(std::any_of(f.correlations.begin(), f.correlations.end(), [&](const CorrelatedPair& p) {
    return p.a == 0 && p.b == added && p.correlation < -0.9;
  }));
}

TEST(Fit, AGpuWithoutRowsKeepsItsStart) {
  Synthetic s = make_synthetic(2, 3);
  std::vector<bool> use = fitted_cells(s.experiment);
  for (std::size_t i = 0; i < use.size(); ++i)
    if (s.experiment.cells[i].run.gpu == "b") use[i] = false;
  const Fit f = fit(s.experiment, use, Predictor(s.experiment, 1).start(), {});
  for (std::size_t k = 0; k < f.estimates.size(); ++k)
    if (s.experiment.parameters[k].member == "b") {
      EXPECT_FALSE(f.estimates[k].used);
      EXPECT_DOUBLE_EQ(f.estimates[k].value, s.experiment.parameters[k].start);
    }
}

TEST(Fit, MoreThanOneParameterForFourValuesIsRefused) {
  Synthetic s = make_synthetic(1, 1);
  EXPECT_THROW(check_parameter_count(s.experiment, fitted_cells(s.experiment)), InputError);
  const Synthetic enough = make_synthetic(3, 6);
  EXPECT_NO_THROW(check_parameter_count(enough.experiment, fitted_cells(enough.experiment)));
}

}  // namespace
}  // namespace hwsim::cost_models::test
