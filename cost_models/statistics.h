#pragma once
// Error figures of predictions against published values.
#include <map>
#include <span>
#include <string>
#include <vector>

namespace hwsim::cost_models {

double percent_error(double predicted, double published);  ///< absolute, of the published value

double mean(std::span<const double> values);
double median(std::vector<double> values);

/// The smallest value that at least `ratio` of the sample does not exceed, with one unseen value counted as
/// larger: ceil((n + 1) ratio)-th smallest, the largest for small samples (split conformal prediction).
double conformal_quantile(std::vector<double> values, double ratio);

/// For each fold the quantile of the values of the other folds, or of all where there is no other.
std::map<std::string, double> quantiles_without(std::span<const std::string> folds,
                                                std::span<const double> values, double ratio);

/// Members of the same group are compared with each other.
struct Ranked {
  std::string group;
  double predicted = 0.0, published = 0.0;
};

/// Kendall's tau over the pairs of each group, pairs that were published equal left out. 1 without pairs.
double kendall(std::span<const Ranked> values);

/// Least squares of y on the columns of x and a constant; the constant is the last coefficient.
std::vector<double> linear_regression(std::span<const std::vector<double>> x, std::span<const double> y);

}  // namespace hwsim::cost_models
