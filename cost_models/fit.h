#pragma once
// Robust least squares of ln(predicted / published) over the parameters, in their logarithms, within their
// ranges and with their priors.
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cost_models/experiment.h"

namespace hwsim::cost_models {

struct FitOptions {
  int starts = 1;             ///< the first from the declared start, the others at random within the ranges
  std::uint64_t seed = 1;     ///< seed of the random starts
  int jobs = 1;               ///< the result does not depend on it
  int max_iterations = 100;   ///< most iterations of each start
  bool convex_first = true;   ///< begin with a loss that sees far rows too
  double noise_log_sd = 0.1;  ///< a residual of this size costs as much as a parameter one prior sd away
  double robust_log = 0.2;    ///< residuals beyond this lose weight (Cauchy): rows that nothing explains
  std::function<void(int start, int iteration, double cost)> progress;  ///< may be empty
};

/// A parameter after the fit.
struct Estimate {
  double value = 0.0, low90 = 0.0, high90 = 0.0;
  bool used = false;  ///< some fitted cell depends on it; otherwise it kept its start
  bool at_bound = false;
  bool identified = true;  ///< the data narrow it down further than its prior or its range
  /// As a number of hardware: neither pushed to an end of its range, nor far from what the other GPUs have.
  bool credible = true;
};

struct CorrelatedPair {
  std::size_t a = 0, b = 0;
  double correlation = 0.0;
};

/// Where one start ended.
struct StartOutcome {
  double cost = 0.0;
  int iterations = 0;
  bool converged = false;
  bool same_optimum = false;  ///< as the best
};

struct Fit {
  std::vector<double> log_values;
  std::vector<double>
      covariance;  ///< covariance of log_values, row by row; zero for parameters that are fixed or at a bound
  std::vector<Estimate> estimates;
  double residual_log_sd = 0.0;
  std::size_t fitted_values = 0, used_parameters = 0;
  double start_cost = 0.0, cost = 0.0;
  double gain_ratio = 0.0;  ///< part of the cost that a further step would save; an optimum has none
  int iterations = 0;
  bool converged = false;
  std::string message;     ///< what the solver said
  double condition = 0.0;  ///< condition of the Jacobian with columns of unit length, priors included
  std::vector<CorrelatedPair> correlations;  ///< beyond 0.9
  std::vector<StartOutcome> starts;
};

/// Fits to the cells that `use` marks (and that a replay predicts). Scenes without such a cell get the
/// typical factors of the others, with their spread as variance.
Fit fit(const Experiment& experiment, const std::vector<bool>& use, const std::vector<double>& start,
        const FitOptions& options);

/// Two fits whose costs differ by less than this part are in the same optimum.
inline constexpr double kSameCost = 1e-3;

/// The fit that ended at `log_values`, with all that fit() says about it, after one evaluation: nothing is
/// solved. It is an optimum where gain_ratio is below kSameCost.
Fit fit_at(const Experiment& experiment, const std::vector<bool>& use, const std::vector<double>& log_values,
           const FitOptions& options);

/// Cells of use `fitted` that a replay predicts.
std::vector<bool> fitted_cells(const Experiment& experiment);

/// Parameters that some marked cell depends on.
std::vector<bool> used_parameters(const Experiment& experiment, const std::vector<bool>& use);

/// Throws InputError M005 when there is more than one parameter for four fitted values.
void check_parameter_count(const Experiment& experiment, const std::vector<bool>& use);

}  // namespace hwsim::cost_models
