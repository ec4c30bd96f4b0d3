#pragma once
// How well a fit determines its parameters.
#include "cost_models/fit.h"

namespace hwsim::cost_models {

/// Fills cost, gain_ratio, covariance, residual_log_sd, condition and correlations from the linearization at
/// the optimum. The noise is the residuals' own; parameters at a bound are held there.
void add_covariance(const Experiment& experiment, const std::vector<bool>& use, const std::vector<bool>& used,
                    const FitOptions& options, Fit& fit);

/// Variance of ln(prediction) that the parameters' uncertainty gives.
double log_variance(const std::vector<double>& covariance, const std::vector<double>& gradient);

}  // namespace hwsim::cost_models
