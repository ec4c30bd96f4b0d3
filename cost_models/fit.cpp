#include "cost_models/fit.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "cost_models/covariance.h"
#include "cost_models/predictor.h"

namespace hwsim::cost_models {
namespace {

constexpr double kBoundDistance = 1e-6;  // in ln(value)
constexpr std::size_t kValuesPerParameter = 4;

/// All predictions at a point, computed once for every residual of it.
class SharedEvaluation : public ceres::EvaluationCallback {
 public:
  SharedEvaluation(const Experiment& experiment, const std::vector<bool>& use,
                   const std::vector<double>& values, int jobs)
      : predictor_(experiment, jobs, use), values_(values) {}

  void PrepareForEvaluation(bool jacobians, bool new_point) override {
    if (!new_point && (has_gradients_ || !jacobians)) return;
    predictor_.evaluate(values_, jacobians);
    has_gradients_ = jacobians;
  }
  const Prediction& operator[](std::size_t cell) const { return predictor_[cell]; }

 private:
  Predictor predictor_;
  const std::vector<double>& values_;
  bool has_gradients_ = false;
};

/// ln(predicted / published) in units of the noise.
class CellResidual : public ceres::CostFunction {
 public:
  CellResidual(const SharedEvaluation& shared, std::size_t cell, double published, double noise,
               std::vector<std::size_t> parameters)
      : shared_(shared),
        cell_(cell),
        log_published_(std::log(published)),
        noise_(noise),
        parameters_(std::move(parameters)) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->assign(parameters_.size(), 1);
  }

  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    const Prediction& prediction = shared_[cell_];
    residuals[0] = (std::log(prediction.ms) - log_published_) / noise_;
    if (!std::isfinite(residuals[0])) return false;
    if (jacobians == nullptr) return true;
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      if (jacobians[i] != nullptr) jacobians[i][0] = prediction.gradient[parameters_[i]] / noise_;
    return true;
  }

 private:
  const SharedEvaluation& shared_;
  std::size_t cell_;
  double log_published_, noise_;
  std::vector<std::size_t> parameters_;
};

/// A parameter about a known center.
class PriorResidual : public ceres::SizedCostFunction<1, 1> {
 public:
  PriorResidual(double center, double sd) : center_(center), sd_(sd) {}
  bool Evaluate(double const* const* values, double* residuals, double** jacobians) const override {
    residuals[0] = (values[0][0] - center_) / sd_;
    if (jacobians != nullptr && jacobians[0] != nullptr) jacobians[0][0] = 1.0 / sd_;
    return true;
  }

 private:
  double center_, sd_;
};

/// A parameter about another one, which is fitted, too.
class PooledResidual : public ceres::SizedCostFunction<1, 1, 1> {
 public:
  explicit PooledResidual(double sd) : sd_(sd) {}
  bool Evaluate(double const* const* values, double* residuals, double** jacobians) const override {
    residuals[0] = (values[0][0] - values[1][0]) / sd_;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) jacobians[0][0] = 1.0 / sd_;
    if (jacobians[1] != nullptr) jacobians[1][0] = -1.0 / sd_;
    return true;
  }

 private:
  double sd_;
};

/// Reports, and ends a start that has arrived where a finished one did: it is as low and hardly moves.
class ProgressCallback : public ceres::IterationCallback {
 public:
  ProgressCallback(const FitOptions& options, int start, double known_cost)
      : options_(options), start_(start), known_cost_(known_cost) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (options_.progress) options_.progress(start_, summary.iteration, summary.cost);
    const bool arrived = std::abs(summary.cost - known_cost_) <= 0.5 * kSameCost * known_cost_;
    const bool still = summary.iteration > 0 && summary.step_is_successful &&
                       std::abs(summary.cost_change) < kSameCost * summary.cost;
    return arrived && still ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  const FitOptions& options_;
  int start_;
  double known_cost_;  ///< negative: none
};

std::vector<std::size_t> parameters_of(const Experiment& experiment, std::size_t cell) {
  std::vector<std::size_t> indices;
  const Cell& c = experiment.cells[cell];
  for (std::size_t i = 0; i < experiment.parameters.size(); ++i)
    if (experiment.parameters[i].concerns(c.run.gpu, c.scene_group)) indices.push_back(i);
  return indices;
}

/// One start: the problem, solved.
class Solve {
 public:
  Solve(const Experiment& experiment, const std::vector<bool>& use, std::vector<double> start,
        const FitOptions& options, int index, double known_cost)
      : experiment_(experiment), values_(std::move(start)), shared_(experiment, use, values_, options.jobs) {
    // A redescending loss sees no slope far away: a convex one brings the values near first.
    if (options.convex_first) solve(use, options, index, Loss::huber, kNoCost);
    solve(use, options, index, Loss::cauchy, known_cost);
  }

  const std::vector<double>& values() const { return values_; }
  const ceres::Solver::Summary& summary() const { return summary_; }

 private:
  enum class Loss { huber, cauchy };
  static constexpr double kNoCost = -1.0;

  void solve(const std::vector<bool>& use, const FitOptions& options, int index, Loss loss,
             double known_cost) {
    ceres::Problem::Options problem_options;
    problem_options.evaluation_callback = &shared_;
    ceres::Problem problem(problem_options);
    const std::vector<bool> used = used_parameters(experiment_, use);
    for (std::size_t i = 0; i < values_.size(); ++i)
      if (used[i]) add_parameter(problem, i);
    for (const Prior& prior : priors_of(experiment_.parameters, used)) add_prior(problem, prior);
    for (std::size_t cell = 0; cell < use.size(); ++cell)
      if (use[cell]) add_cell(problem, cell, options, loss);
    ProgressCallback progress(options, index, known_cost);
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_QR;
    solver.max_num_iterations = loss == Loss::huber ? options.max_iterations / 4 : options.max_iterations;
    solver.function_tolerance = 1e-6;
    solver.parameter_tolerance = 1e-6;
    solver.logging_type = ceres::SILENT;
    solver.callbacks.push_back(&progress);
    ceres::Solve(solver, &problem, &summary_);
  }

  void add_parameter(ceres::Problem& problem, std::size_t i) {
    const FittedParameter& p = experiment_.parameters[i];
    problem.AddParameterBlock(&values_[i], 1);
    problem.SetParameterLowerBound(&values_[i], 0, std::log(p.low));
    problem.SetParameterUpperBound(&values_[i], 0, std::log(p.high));
  }

  void add_prior(ceres::Problem& problem, const Prior& prior) {
    if (prior.around)
      problem.AddResidualBlock(new PooledResidual(prior.log_sd), nullptr, &values_[prior.of],
                               &values_[*prior.around]);
    else
      problem.AddResidualBlock(new PriorResidual(prior.log_center, prior.log_sd), nullptr,
                               &values_[prior.of]);
  }

  void add_cell(ceres::Problem& problem, std::size_t cell, const FitOptions& options, Loss loss) {
    std::vector<std::size_t> indices = parameters_of(experiment_, cell);
    if (indices.empty()) return;
    std::vector<double*> blocks;
    for (const std::size_t i : indices) blocks.push_back(&values_[i]);
    const double scale = options.robust_log / options.noise_log_sd;
    ceres::LossFunction* robust = loss == Loss::huber
                                      ? static_cast<ceres::LossFunction*>(new ceres::HuberLoss(scale))
                                      : new ceres::CauchyLoss(scale);
    problem.AddResidualBlock(new CellResidual(shared_, cell, experiment_.cells[cell].published,
                                              options.noise_log_sd, std::move(indices)),
                             robust, blocks);
  }

  const Experiment& experiment_;
  std::vector<double> values_;
  SharedEvaluation shared_;
  ceres::Solver::Summary summary_;
};

/// SplitMix64: the same starts everywhere.
double uniform(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15ULL;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
}

std::vector<double> random_start(const Experiment& experiment, std::uint64_t& state) {
  std::vector<double> values;
  for (const FittedParameter& p : experiment.parameters)
    values.push_back(std::log(p.low) + uniform(state) * std::log(p.high / p.low));
  return values;
}

/// Scenes that no fitted cell shows: the geometric mean of the others.
void set_typical_factors(const Experiment& experiment, const std::vector<bool>& used, Fit& result) {
  const std::size_t n = experiment.parameters.size();
  for (std::size_t i = 0; i < n; ++i) {
    const FittedParameter& p = experiment.parameters[i];
    if (p.scope != Scope::scene || used[i]) continue;
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      if (!used[k] || experiment.parameters[k].scope != Scope::scene ||
          experiment.parameters[k].name != p.name)
        continue;
      sum += result.log_values[k];
      squares += result.log_values[k] * result.log_values[k];
      count += 1.0;
    }
    if (count < 2.0) continue;
    result.log_values[i] = std::clamp(sum / count, std::log(p.low), std::log(p.high));
    result.covariance[i * n + i] = std::max(0.0, (squares - sum * sum / count) / (count - 1.0));
  }
}

/// What no fitted cell shows of a GPU is what the others have, as far as they tell.
void set_pooled(const Experiment& experiment, const std::vector<bool>& used, Fit& result) {
  const std::size_t n = experiment.parameters.size();
  for (std::size_t i = 0; i < n; ++i) {
    const FittedParameter& p = experiment.parameters[i];
    if (used[i] || !p.pooled_with || !used[*p.pooled_with]) continue;
    const std::size_t all = *p.pooled_with;
    result.log_values[i] = std::clamp(result.log_values[all], std::log(p.low), std::log(p.high));
    for (std::size_t k = 0; k < n; ++k)
      result.covariance[i * n + k] = result.covariance[k * n + i] = result.covariance[all * n + k];
    result.covariance[i * n + i] = result.covariance[all * n + all] + p.prior_log_sd * p.prior_log_sd;
  }
}

/// An end of the range that is also the documented value is no sign of a fault.
bool is_credible(const FittedParameter& p, const Estimate& e, const std::vector<double>& log_values) {
  constexpr double kFarInPriors = 2.0;
  if (e.at_bound && std::abs(e.value / p.start - 1.0) > 1e-6) return false;
  return !p.pooled_with ||
         std::abs(std::log(e.value) - log_values[*p.pooled_with]) < kFarInPriors * p.prior_log_sd;
}

void set_estimates(const Experiment& experiment, const std::vector<bool>& used, Fit& result) {
  constexpr double kNormal90 = 1.6448536269514722;
  const std::size_t n = experiment.parameters.size();
  result.estimates.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const FittedParameter& p = experiment.parameters[i];
    Estimate& e = result.estimates[i];
    const double sd = std::sqrt(result.covariance[i * n + i]);
    e.value = std::exp(result.log_values[i]);
    e.used = used[i];
    const double range = std::log(p.high / p.low);
    e.at_bound = used[i] && (result.log_values[i] < std::log(p.low) + kBoundDistance * range ||
                             result.log_values[i] > std::log(p.high) - kBoundDistance * range);
    e.low90 = std::max(p.low, e.value * std::exp(-kNormal90 * sd));
    e.high90 = std::min(p.high, e.value * std::exp(kNormal90 * sd));
    const double without_data = p.prior_log_sd > 0.0 ? p.prior_log_sd : range / std::sqrt(12.0);
    e.identified = !used[i] || e.at_bound || sd < 0.8 * without_data;
    e.credible = p.scope == Scope::scene || !used[i] || is_credible(p, e, result.log_values);
  }
}

/// What is known about the fit at its values: cost, uncertainty, estimates.
void describe(const Experiment& experiment, const std::vector<bool>& use, const std::vector<bool>& used,
              const FitOptions& options, Fit& result) {
  result.fitted_values = static_cast<std::size_t>(std::count(use.begin(), use.end(), true));
  result.used_parameters = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  add_covariance(experiment, use, used, options, result);
  set_typical_factors(experiment, used, result);
  set_pooled(experiment, used, result);
  set_estimates(experiment, used, result);
}

}  // namespace

std::vector<bool> fitted_cells(const Experiment& experiment) {
  std::vector<bool> use(experiment.cells.size(), false);
  for (const Replay& replay : experiment.replays)
    for (const std::size_t cell : replay.cells) use[cell] = experiment.cells[cell].use == RowUse::fitted;
  return use;
}

std::vector<bool> used_parameters(const Experiment& experiment, const std::vector<bool>& use) {
  std::vector<bool> used(experiment.parameters.size(), false);
  for (std::size_t cell = 0; cell < use.size(); ++cell)
    if (use[cell])
      for (const std::size_t i : parameters_of(experiment, cell)) used[i] = true;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (const auto& all = experiment.parameters[i].pooled_with; used[i] && all) used[*all] = true;
  return used;
}

void check_parameter_count(const Experiment& experiment, const std::vector<bool>& use) {
  const auto values = static_cast<std::size_t>(std::count(use.begin(), use.end(), true));
  const std::vector<bool> used = used_parameters(experiment, use);
  const auto parameters = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  if (parameters * kValuesPerParameter <= values) return;
  throw InputError(Diagnostic{.code = "M005",
                              .message = std::to_string(parameters) + " parameters for " +
                                         std::to_string(values) + " fitted values: more than one for four"});
}

Fit fit(const Experiment& experiment, const std::vector<bool>& use, const std::vector<double>& start,
        const FitOptions& options) {
  const std::vector<bool> used = used_parameters(experiment, use);
  std::uint64_t state = options.seed;
  Fit result;
  std::vector<std::vector<double>> ends;
  std::size_t best = 0;
  for (int i = 0; i < options.starts; ++i) {
    std::vector<double> from = start;
    if (i > 0) {
      const std::vector<double> random = random_start(experiment, state);
      for (std::size_t k = 0; k < from.size(); ++k)
        if (used[k]) from[k] = random[k];
    }
    for (std::size_t k = 0; k < from.size(); ++k)
      from[k] = std::clamp(from[k], std::log(experiment.parameters[k].low),
                           std::log(experiment.parameters[k].high));
    const Solve solve(experiment, use, from, options, i, i == 0 ? -1.0 : result.cost);
    const ceres::Solver::Summary& s = solve.summary();
    const bool arrived = s.termination_type == ceres::USER_SUCCESS;
    ends.push_back(solve.values());
    result.starts.push_back({s.final_cost, static_cast<int>(s.iterations.size()),
                             s.termination_type == ceres::CONVERGENCE || arrived, false});
    if (i == 0) result.start_cost = s.initial_cost;
    if (i > 0 && (arrived || s.final_cost >= result.cost)) continue;
    best = ends.size() - 1;
    result.cost = s.final_cost;
    result.iterations = result.starts.back().iterations;
    result.converged = result.starts.back().converged;
    result.message = s.message;
  }
  for (StartOutcome& outcome : result.starts)
    outcome.same_optimum = outcome.cost <= result.cost * (1.0 + kSameCost) + 1e-9;
  result.log_values = ends[best];
  describe(experiment, use, used, options, result);
  return result;
}

Fit fit_at(const Experiment& experiment, const std::vector<bool>& use, const std::vector<double>& log_values,
           const FitOptions& options) {
  Fit result;
  result.log_values = log_values;
  result.converged = true;
  describe(experiment, use, used_parameters(experiment, use), options, result);
  result.start_cost = result.cost;
  return result;
}

}  // namespace hwsim::cost_models
