#pragma once
// Published ratios of two techniques beside predicted ones, on data that the fit did not see.
#include "cost_models/validation.h"

namespace hwsim::cost_models {

/// Fills ratios, ratio_quantile90 and ratio_figures of every split, and ratio_log_sd, which comes from the
/// scenes held out. The intervals of a fold use the other folds.
void add_ratios(const Experiment& experiment, Validation& validation);

/// Variance of ln(second / first) that the parameters' uncertainty gives: what both depend on cancels.
double log_ratio_variance(const std::vector<double>& covariance, const std::vector<double>& first,
                          const std::vector<double>& second);

}  // namespace hwsim::cost_models
