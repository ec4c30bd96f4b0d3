#include "cost_models/statistics.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace hwsim::cost_models {

double percent_error(double predicted, double published) {
  return std::abs(predicted - published) / published * 100.0;
}

double mean(std::span<const double> values) {
  if (values.empty()) return 0.0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double conformal_quantile(std::vector<double> values, double ratio) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(static_cast<double>(values.size() + 1) * ratio));
  return values[std::min(rank, values.size()) - 1];
}

std::map<std::string, double> quantiles_without(std::span<const std::string> folds,
                                                std::span<const double> values, double ratio) {
  const double of_all = conformal_quantile({values.begin(), values.end()}, ratio);
  std::map<std::string, double> quantiles;
  for (const std::string& fold : folds) quantiles[fold] = of_all;
  for (auto& [fold, quantile] : quantiles) {
    std::vector<double> others;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (folds[i] != fold) others.push_back(values[i]);
    if (!others.empty()) quantile = conformal_quantile(std::move(others), ratio);
  }
  return quantiles;
}

double kendall(std::span<const Ranked> values) {
  double agree = 0.0, pairs = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t j = i + 1; j < values.size(); ++j) {
      if (values[i].group != values[j].group || values[i].published == values[j].published) continue;
      const double product =
          (values[i].predicted - values[j].predicted) * (values[i].published - values[j].published);
      agree += product > 0.0 ? 1.0 : product < 0.0 ? -1.0 : 0.0;
      pairs += 1.0;
    }
  return pairs > 0.0 ? agree / pairs : 1.0;
}

std::vector<double> linear_regression(std::span<const std::vector<double>> x, std::span<const double> y) {
  const auto rows = static_cast<Eigen::Index>(x.size());
  const auto columns = static_cast<Eigen::Index>(x.empty() ? 0 : x.front().size());
  Eigen::MatrixXd a(rows, columns + 1);
  Eigen::VectorXd b(rows);
  for (Eigen::Index r = 0; r < rows; ++r) {
    for (Eigen::Index c = 0; c < columns; ++c)
      a(r, c) = x[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
    a(r, columns) = 1.0;
    b(r) = y[static_cast<std::size_t>(r)];
  }
  const Eigen::VectorXd solution = a.colPivHouseholderQr().solve(b);
  return {solution.data(), solution.data() + solution.size()};
}

}  // namespace hwsim::cost_models
