#include "cost_models/covariance.h"

#include <Eigen/Dense>
#include <cmath>
#include <utility>

#include "cost_models/predictor.h"

namespace hwsim::cost_models {
namespace {

constexpr double kStrongCorrelation = 0.9;
constexpr double kBoundDistance = 1e-6;  // as a part of the range, in ln(value)
constexpr double kNullSpace = 1e-10;     // as a part of the largest eigenvalue

std::vector<std::size_t> free_parameters(const Experiment& experiment, const std::vector<bool>& used,
                                         const std::vector<double>& log_values) {
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const FittedParameter& p = experiment.parameters[i];
    const double margin = kBoundDistance * std::log(p.high / p.low);
    if (used[i] && log_values[i] > std::log(p.low) + margin && log_values[i] < std::log(p.high) - margin)
      free.push_back(i);
  }
  return free;
}

/// The rows of the weighted Jacobian and the weighted residuals, without the noise, and their sums. The sums
/// of all parameters also hold those at a bound.
struct Linearization {
  Eigen::MatrixXd rows;  ///< the free parameters'
  Eigen::VectorXd residuals;
  std::vector<double> slope, curvature;  ///< all parameters': row by residual, row by row
  double squares = 0.0, weights = 0.0;
  double loss = 0.0;  ///< the Cauchy loss of all residuals, in units of robust_log^2
};

Linearization linearize(const Experiment& experiment, const std::vector<bool>& use,
                        const std::vector<std::size_t>& free, const FitOptions& options, const Fit& fit) {
  Predictor predictor(experiment, options.jobs, use);
  predictor.evaluate(fit.log_values, true);
  Linearization result;
  result.rows.resize(static_cast<Eigen::Index>(fit.fitted_values), static_cast<Eigen::Index>(free.size()));
  result.residuals.resize(static_cast<Eigen::Index>(fit.fitted_values));
  result.slope.assign(experiment.parameters.size(), 0.0);
  result.curvature = result.slope;
  Eigen::Index row = 0;
  for (std::size_t cell = 0; cell < use.size(); ++cell) {
    if (!use[cell]) continue;
    const double r = std::log(predictor[cell].ms / experiment.cells[cell].published);
    const double weight = 1.0 / (1.0 + (r / options.robust_log) * (r / options.robust_log));
    for (std::size_t k = 0; k < free.size(); ++k)
      result.rows(row, static_cast<Eigen::Index>(k)) = std::sqrt(weight) * predictor[cell].gradient[free[k]];
    const std::vector<double>& gradient = predictor[cell].gradient;
    for (std::size_t k = 0; k < gradient.size(); ++k) {
      result.slope[k] += weight * r * gradient[k];
      result.curvature[k] += weight * gradient[k] * gradient[k];
    }
    result.residuals(row) = std::sqrt(weight) * r;
    result.loss += std::log1p((r / options.robust_log) * (r / options.robust_log));
    result.squares += weight * r * r;
    result.weights += weight;
    ++row;
  }
  return result;
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information);
  Eigen::VectorXd values = solver.eigenvalues();
  const double least = kNullSpace * std::max(values.maxCoeff(), 1e-300);
  for (double& value : values) value = 1.0 / std::max(value, least);
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

double condition_of(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd unit = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(unit).eigenvalues();
  return std::sqrt(values.maxCoeff() / std::max(values.minCoeff(), 1e-300));
}

/// What the priors add to slope and curvature of the cost.
struct PriorTerms {
  Eigen::VectorXd slope;
  Eigen::MatrixXd curvature;
};

PriorTerms prior_terms(const Experiment& experiment, const std::vector<bool>& used,
                       const std::vector<double>& log_values) {
  const auto n = static_cast<Eigen::Index>(used.size());
  PriorTerms terms{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
  for (const Prior& prior : priors_of(experiment.parameters, used)) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(n);
    row(static_cast<Eigen::Index>(prior.of)) = 1.0 / prior.log_sd;
    if (prior.around) row(static_cast<Eigen::Index>(*prior.around)) = -1.0 / prior.log_sd;
    terms.slope += prior.offset(log_values) * row;
    terms.curvature += row * row.transpose();
  }
  return terms;
}

/// The part of a matrix of all parameters that belongs to some.
Eigen::MatrixXd part_of(const Eigen::MatrixXd& all, const std::vector<std::size_t>& some) {
  Eigen::MatrixXd part(static_cast<Eigen::Index>(some.size()), static_cast<Eigen::Index>(some.size()));
  for (std::size_t a = 0; a < some.size(); ++a)
    for (std::size_t b = 0; b < some.size(); ++b)
      part(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) =
          all(static_cast<Eigen::Index>(some[a]), static_cast<Eigen::Index>(some[b]));
  return part;
}

/// The cost that the solver minimizes.
double cost_of(const Experiment& experiment, const std::vector<bool>& used, const FitOptions& options,
               const Linearization& linear, const Fit& fit) {
  const double scale = options.robust_log / options.noise_log_sd;
  double sum = scale * scale * linear.loss;
  for (const Prior& prior : priors_of(experiment.parameters, used)) {
    const double offset = prior.offset(fit.log_values);
    sum += offset * offset;
  }
  return 0.5 * sum;
}

/// What a Gauss-Newton step of the free parameters would save, and a step of each one that leaves its bound.
double gain_of(const Experiment& experiment, const std::vector<bool>& used,
               const std::vector<std::size_t>& free, const FitOptions& options, const Linearization& linear,
               const Fit& fit) {
  const double noise = options.noise_log_sd * options.noise_log_sd;
  const PriorTerms priors = prior_terms(experiment, used, fit.log_values);
  Eigen::VectorXd slope = linear.rows.transpose() * linear.residuals / noise;
  const Eigen::MatrixXd curvature =
      linear.rows.transpose() * linear.rows / noise + part_of(priors.curvature, free);
  std::vector<bool> bound = used;
  for (std::size_t k = 0; k < free.size(); ++k) {
    slope(static_cast<Eigen::Index>(k)) += priors.slope(static_cast<Eigen::Index>(free[k]));
    bound[free[k]] = false;
  }
  double gain = free.empty() ? 0.0 : 0.5 * slope.dot(inverse(curvature) * slope);
  for (std::size_t k = 0; k < bound.size(); ++k) {
    if (!bound[k]) continue;
    const FittedParameter& p = experiment.parameters[k];
    const auto i = static_cast<Eigen::Index>(k);
    const double g = linear.slope[k] / noise + priors.slope(i);
    const double h = linear.curvature[k] / noise + priors.curvature(i, i);
    const bool at_low = fit.log_values[k] < 0.5 * (std::log(p.low) + std::log(p.high));
    if (h > 0.0 && (at_low ? g < 0.0 : g > 0.0)) gain += 0.5 * g * g / h;
  }
  return gain;
}

}  // namespace

void add_covariance(const Experiment& experiment, const std::vector<bool>& use, const std::vector<bool>& used,
                    const FitOptions& options, Fit& fit) {
  const std::size_t n = experiment.parameters.size();
  fit.covariance.assign(n * n, 0.0);
  const std::vector<std::size_t> free = free_parameters(experiment, used, fit.log_values);
  const Linearization linear = linearize(experiment, use, free, options, fit);
  const double freedom = std::max(1.0, linear.weights - static_cast<double>(free.size()));
  fit.residual_log_sd = std::sqrt(std::max(linear.squares / freedom, 1e-12));
  fit.cost = cost_of(experiment, used, options, linear, fit);
  fit.gain_ratio = fit.cost > 0.0 ? gain_of(experiment, used, free, options, linear, fit) / fit.cost : 0.0;
  if (free.empty()) return;
  const Eigen::MatrixXd information =
      linear.rows.transpose() * linear.rows / (fit.residual_log_sd * fit.residual_log_sd) +
      part_of(prior_terms(experiment, used, fit.log_values).curvature, free);
  fit.condition = condition_of(information);
  const Eigen::MatrixXd covariance = inverse(information);
  for (std::size_t a = 0; a < free.size(); ++a)
    for (std::size_t b = 0; b < free.size(); ++b) {
      const auto i = static_cast<Eigen::Index>(a), j = static_cast<Eigen::Index>(b);
      fit.covariance[free[a] * n + free[b]] = covariance(i, j);
      const double correlation = covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
      if (a < b && std::abs(correlation) > kStrongCorrelation)
        fit.correlations.push_back({free[a], free[b], correlation});
    }
}

double log_variance(const std::vector<double>& covariance, const std::vector<double>& gradient) {
  const std::size_t n = gradient.size();
  double sum = 0.0;
  for (std::size_t a = 0; a < n; ++a) {
    if (gradient[a] == 0.0) continue;
    for (std::size_t b = 0; b < n; ++b) sum += gradient[a] * covariance[a * n + b] * gradient[b];
  }
  return std::max(0.0, sum);
}

}  // namespace hwsim::cost_models
