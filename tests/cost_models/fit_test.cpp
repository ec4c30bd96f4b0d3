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

/// Central differences of one cell by one parameter.
double slope_of(const Experiment& e, std::size_t cell, std::size_t parameter, std::vector<double> at) {
  constexpr double kStep = 1e-6;
  Predictor predictor(e, 1);
  at[parameter] += kStep;
  predictor.evaluate(at, false);
  const double high = std::log(predictor[cell].ms);
  at[parameter] -= 2.0 * kStep;
  predictor.evaluate(at, false);
  return (high - std::log(predictor[cell].ms)) / (2.0 * kStep);
}

// One row is of a whole frame, the others of single passes.
TEST(Predictor, PresentTimeBelongsToWholeFramesAlone) {
  Synthetic s = make_synthetic(1, 2);
  s.experiment.cells[0].passes = "*";
  s.experiment.parameters.push_back(parameter(Scope::gpu, "a", std::string(kPresent), 400.0, 100.0, 3000.0));
  s.truth.push_back(std::log(500.0));
  const std::size_t added = s.truth.size() - 1;
  Predictor with(s.experiment, 1);
  with.evaluate(s.truth, true);
  EXPECT_NEAR(with[0].gradient[added], 0.5 / with[0].ms, 1e-12);
  EXPECT_NEAR(with[0].gradient[added], slope_of(s.experiment, 0, added, s.truth), 1e-6);
  EXPECT_EQ(with[1].gradient[added], 0.0);
}

TEST(Predictor, RowsOfRepeatedPassesTakeSoManyTimes) {
  Synthetic s = make_synthetic(1, 1);
  Predictor once(s.experiment, 1);
  once.evaluate(s.truth, true);
  s.experiment.cells[0].repeat = 4.0;
  Predictor repeated(s.experiment, 1);
  repeated.evaluate(s.truth, true);
  EXPECT_NEAR(repeated[0].ms, 4.0 * once[0].ms, 1e-12);
  for (std::size_t k = 0; k < s.truth.size(); ++k)
    EXPECT_NEAR(repeated[0].gradient[k], once[0].gradient[k], 1e-12);
}

// The light is that of another run: halfway between them at a reach of a half.
TEST(Predictor, LightReachScalesWhatTheLightsAdd) {
  Synthetic s = make_synthetic(1, 1);
  Replay& replay = s.experiment.replays[0];
  auto lit = std::make_shared<WorkTrace>(*replay.trace);
  for (PassCounters& chunk : lit->passes[1].chunks) {
    chunk.shader.alu_lane_ops *= 3;
    chunk.shader.alu_issued_lane_ops_w32 *= 3;
  }
  replay.unlit = replay.trace;
  replay.trace = lit;
  s.experiment.parameters.push_back(
      parameter(Scope::scene, "scene0", std::string(kLightReach), 1.0, 0.05, 8.0));
  s.truth.push_back(0.0);
  const std::size_t reach = s.truth.size() - 1;
  const auto light_ms = [&](double value) {
    s.truth[reach] = std::log(value);
    Predictor predictor(s.experiment, 1);
    predictor.evaluate(s.truth, false);
    return predictor[1].ms;
  };
  EXPECT_GT(light_ms(1.0), light_ms(0.05));
  EXPECT_NEAR(light_ms(2.0) - light_ms(1.0), 2.0 * (light_ms(1.0) - light_ms(0.5)), 1e-9);
  Predictor predictor(s.experiment, 1);
  predictor.evaluate(s.truth, true);
  EXPECT_NEAR(predictor[1].gradient[reach], slope_of(s.experiment, 1, reach, s.truth), 1e-6);
}

TEST(Predictor, OwnParameterTakesThePlaceOfTheOneForAll) {
  Synthetic s = make_synthetic(1, 1);
  for (FittedParameter& p : s.experiment.parameters)
    if (p.scope == Scope::all) p.own_of = {"a"};
  s.experiment.parameters.push_back(parameter(Scope::gpu, "a", "alu_efficiency_ratio", 0.8, 0.1, 1.0));
  s.truth.push_back(std::log(0.5));
  Predictor predictor(s.experiment, 1);
  predictor.evaluate(s.truth, true);
  bool own_moves = false, shared_moves = false;
  for (std::size_t i = 0; i < s.experiment.cells.size(); ++i)
    for (std::size_t k = 0; k < s.truth.size(); ++k) {
      const FittedParameter& p = s.experiment.parameters[k];
      if (p.name != "alu_efficiency_ratio" || s.experiment.cells[i].run.gpu != "a") continue;
      (p.scope == Scope::all ? shared_moves : own_moves) |= predictor[i].gradient[k] != 0.0;
    }
  EXPECT_TRUE(own_moves);
  EXPECT_FALSE(shared_moves);
}

TEST(Predictor, EqualPassesAreTimedOnceWithTheSameResult) {
  Synthetic s = make_synthetic(1, 3);
  Predictor apart(s.experiment, 1);
  apart.evaluate(s.truth, true);
  for (std::size_t r = 0; r < s.experiment.replays.size(); ++r)
    s.experiment.replays[r].pass_keys = {r, 100 + r, 200 + r};
  Replay& last = s.experiment.replays[2];
  last.trace = s.experiment.replays[0].trace;
  last.pass_keys = s.experiment.replays[0].pass_keys;
  Predictor shared(s.experiment, 1);
  shared.evaluate(s.truth, true);
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_EQ(shared[last.cells[p]].ms, shared[s.experiment.replays[0].cells[p]].ms);
    EXPECT_EQ(shared[s.experiment.replays[0].cells[p]].ms, apart[s.experiment.replays[0].cells[p]].ms);
  }
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
  // A number that limits no pass may end anywhere beyond: times do not know it.
  Predictor predictor(s.experiment, 1);
  predictor.evaluate(s.truth, true);
  std::size_t found = 0;
  for (std::size_t k = 0; k < s.truth.size(); ++k) {
    double most = 0.0;
    for (std::size_t i = 0; i < ms.size(); ++i) most = std::max(most, std::abs(predictor[i].gradient[k]));
    if (most < 0.1 || f.estimates[k].at_bound) continue;
    EXPECT_NEAR(f.log_values[k], s.truth[k], 0.01) << s.experiment.parameters[k].id();
    ++found;
  }
  EXPECT_GT(found, 6u);
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

TEST(Fit, TenStartsEndInTheSameOptimum) {
  const Synthetic s = make_synthetic(2, 4);
  const Fit f = fit_all(s.experiment, 10);
  const auto same =
      std::count_if(f.starts.begin(), f.starts.end(), [](const auto& o) { return o.same_optimum; });
  EXPECT_EQ(same, 10);
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
