#include "cost_models/ratios.h"

#include <cmath>

#include "cost_models/covariance.h"
#include "cost_models/statistics.h"

namespace hwsim::cost_models {
namespace {

constexpr double kCoverage = 0.9;
constexpr double kMedianOfNormal = 0.6744897501960817;  // median of |x| of a normal x with deviation 1

/// Every pair of a group whose techniques differ.
std::vector<HeldOutRatio> ratios_of(const Experiment& experiment, const Fit& fit,
                                    const std::vector<HeldOut>& cells) {
  std::vector<std::string> groups;
  for (const HeldOut& c : cells) groups.push_back(rank_group(experiment.cells[c.cell]));
  std::vector<HeldOutRatio> ratios;
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (std::size_t j = i + 1; j < cells.size(); ++j) {
      const HeldOut &a = cells[i], &b = cells[j];
      const Cell &first = experiment.cells[a.cell], &second = experiment.cells[b.cell];
      if (groups[i] != groups[j] || first.run.technique == second.run.technique) continue;
      HeldOutRatio ratio{a.cell, b.cell, a.fold == b.fold ? a.fold : a.fold + " and " + b.fold};
      ratio.predicted = b.predicted_ms / a.predicted_ms;
      ratio.published = second.published / first.published;
      ratio.log_sd = std::sqrt(log_ratio_variance(fit.covariance, a.gradient, b.gradient));
      ratios.push_back(std::move(ratio));
    }
  return ratios;
}

double log_error(const HeldOutRatio& ratio) { return std::log(ratio.predicted / ratio.published); }

/// The spread of the errors, by their median: a misprint moves it little.
double spread_of(const std::vector<HeldOutRatio>& ratios) {
  std::vector<double> errors;
  for (const HeldOutRatio& ratio : ratios) errors.push_back(std::abs(log_error(ratio)));
  return median(std::move(errors)) / kMedianOfNormal;
}

void set_intervals(SplitResult& split) {
  std::vector<double> z;
  std::vector<std::string> folds;
  for (const HeldOutRatio& ratio : split.ratios) {
    z.push_back(ratio.log_sd > 0.0 ? std::abs(log_error(ratio)) / ratio.log_sd : 0.0);
    folds.push_back(ratio.fold);
  }
  split.ratio_quantile90 = conformal_quantile(z, kCoverage);
  const std::map<std::string, double> by_fold = quantiles_without(folds, z, kCoverage);
  for (HeldOutRatio& ratio : split.ratios) {
    const double half = by_fold.at(ratio.fold) * ratio.log_sd;
    ratio.low = ratio.predicted * std::exp(-half);
    ratio.high = ratio.predicted * std::exp(half);
  }
}

RatioFigures figures_of(const std::vector<HeldOutRatio>& ratios) {
  RatioFigures figures{.pairs = ratios.size()};
  if (ratios.empty()) return figures;
  std::vector<double> errors, widths;
  std::size_t inside = 0;
  for (const HeldOutRatio& ratio : ratios) {
    errors.push_back(percent_error(ratio.predicted, ratio.published));
    widths.push_back(ratio.high / ratio.low);
    if (ratio.low <= ratio.published && ratio.published <= ratio.high) ++inside;
  }
  figures.median_ape_pct = median(std::move(errors));
  figures.width_ratio = median(std::move(widths));
  figures.coverage90_pct = 100.0 * static_cast<double>(inside) / static_cast<double>(ratios.size());
  return figures;
}

}  // namespace

double log_ratio_variance(const std::vector<double>& covariance, const std::vector<double>& first,
                          const std::vector<double>& second) {
  std::vector<double> change(first.size());
  for (std::size_t i = 0; i < change.size(); ++i) change[i] = second[i] - first[i];
  return log_variance(covariance, change);
}

void add_ratios(const Experiment& experiment, Validation& validation) {
  for (SplitResult& split : validation.splits) {
    split.ratios = ratios_of(experiment, validation.fit, split.cells);
    if (split.split == Split::leave_scene_out) validation.ratio_log_sd = spread_of(split.ratios);
  }
  const double own_variance = validation.ratio_log_sd * validation.ratio_log_sd;
  for (SplitResult& split : validation.splits) {
    for (HeldOutRatio& ratio : split.ratios)
      ratio.log_sd = std::sqrt(ratio.log_sd * ratio.log_sd + own_variance);
    set_intervals(split);
    split.ratio_figures = figures_of(split.ratios);
  }
}

}  // namespace hwsim::cost_models
