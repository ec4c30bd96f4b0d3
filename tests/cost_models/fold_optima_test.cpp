// Optima of folds come back as they were, and bring a validation to the same figures sooner.
#include "cost_models/fold_optima.h"

#include <gtest/gtest.h>

#include <fstream>

#include "cost_models/synthetic.h"
#include "hwsim/base/diagnostics.h"

namespace hwsim::cost_models::test {
namespace {

std::string written(const std::string& text) {
  const std::string path = testing::TempDir() + "/fold_optima_test.csv";
  std::ofstream(path) << text;
  return path;
}

Validation validated(const Experiment& experiment, const std::vector<FoldOptimum>& known) {
  return validate(
      experiment, FitOptions{}, [](std::size_t, std::size_t, const std::string&) {}, known);
}

TEST(FoldOptima, AValidationThatBeginsThereEndsWithTheSameFiguresSooner) {
  Synthetic s = make_synthetic();
  add_noise(s.experiment, 20.0);
  const Validation cold = validated(s.experiment, {});
  ASSERT_GT(cold.optima.size(), 1u);
  const std::vector<FoldOptimum> known =
      load_fold_optima(written(to_csv(cold.optima, s.experiment.parameters)), s.experiment.parameters);
  const Validation warm = validated(s.experiment, known);
  EXPECT_GT(cold.fit.iterations, 1);
  EXPECT_EQ(warm.fit.iterations, 0) << "an optimum was solved for again";
  ASSERT_EQ(warm.splits.size(), cold.splits.size());
  for (std::size_t i = 0; i < cold.splits.size(); ++i) {
    EXPECT_NEAR(warm.splits[i].figures.mape_pct, cold.splits[i].figures.mape_pct, 0.02);
    EXPECT_NEAR(warm.splits[i].figures.kendall, cold.splits[i].figures.kendall, 0.01);
  }
}

TEST(FoldOptima, ThatAreNoneAreFitsFirstGuessOnly) {
  Synthetic s = make_synthetic();
  add_noise(s.experiment, 20.0);
  const Validation cold = validated(s.experiment, {});
  std::vector<FoldOptimum> wrong = cold.optima;
  for (FoldOptimum& optimum : wrong) optimum.log_values.front() += 0.3;
  const Validation mended = validated(s.experiment, wrong);
  EXPECT_GT(mended.fit.iterations, 0);
  EXPECT_NEAR(mended.fit.cost, cold.fit.cost, kSameCost * cold.fit.cost);
}

TEST(FitAt, HasTheSolversCostAndNoGainAtAnOptimumOnly) {
  Synthetic s = make_synthetic();
  add_noise(s.experiment, 20.0);
  const std::vector<bool> use = fitted_cells(s.experiment);
  const Fit solved = fit(s.experiment, use, Predictor(s.experiment, 1).start(), FitOptions{});
  EXPECT_LT(solved.gain_ratio, kSameCost);
  const Fit at = fit_at(s.experiment, use, solved.log_values, FitOptions{});
  EXPECT_NEAR(at.cost, solved.cost, 1e-9 * solved.cost);
  EXPECT_EQ(at.covariance, solved.covariance);
  for (std::size_t k = 0; k < solved.log_values.size(); ++k) {
    std::vector<double> moved = solved.log_values;
    moved[k] += moved[k] > std::log(s.experiment.parameters[k].start) ? -0.2 : 0.2;  // from a bound: inwards
    const Fit away = fit_at(s.experiment, use, moved, FitOptions{});
    EXPECT_GT(away.gain_ratio, solved.gain_ratio) << s.experiment.parameters[k].id();
  }
}

TEST(FoldOptima, ReadBackTheSameNumbersAndGiveNewParametersTheirStart) {
  const Synthetic s = make_synthetic(1, 1);
  const std::vector<FoldOptimum> optima = {{Split::in_sample, "", s.truth},
                                           {Split::leave_scene_out, "hall:seed=3,detail=5", s.truth}};
  std::vector<FittedParameter> parameters = s.experiment.parameters;
  const std::string text = to_csv(optima, parameters);
  parameters.push_back(parameter(Scope::gpu, "a", "new_key", 3.0, 1.0, 9.0));
  const std::vector<FoldOptimum> back = load_fold_optima(written(text), parameters);
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[1].split, Split::leave_scene_out);
  EXPECT_EQ(back[1].fold, "hall:seed=3,detail=5");
  for (std::size_t k = 0; k < s.truth.size(); ++k) EXPECT_NEAR(back[1].log_values[k], s.truth[k], 1e-12);
  EXPECT_DOUBLE_EQ(back[1].log_values.back(), std::log(3.0));
}

TEST(FoldOptima, ThatAreDamagedAreRefusedWithTheirLine) {
  const std::vector<FittedParameter> parameters = {parameter(Scope::gpu, "a", "key", 2.0, 1.0, 4.0)};
  for (const char* row : {"no_split,,2", "in_sample,,-2", "in_sample,,nan", "in_sample,,", "in_sample,,2x"}) {
    SCOPED_TRACE(row);
    try {
      load_fold_optima(written("split,fold,a.key\nin_sample,,2\n" + std::string(row) + "\n"), parameters);
      FAIL() << "it was believed";
    } catch (const InputError& error) {
      EXPECT_EQ(error.diagnostics().front().code, "M009");
      EXPECT_EQ(error.diagnostics().front().place.line, 3);
      EXPECT_FALSE(error.diagnostics().front().help.empty());
    }
  }
}

}  // namespace
}  // namespace hwsim::cost_models::test
