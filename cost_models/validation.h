#pragma once
// Errors on data that the fit did not see, beside what simple rules would predict.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cost_models/fit.h"

namespace hwsim::cost_models {

/// How the cells are divided: each fold is predicted by a fit to the others.
enum class Split { in_sample, leave_scene_out, leave_technique_out, rate_extrapolation, leave_gpu_out };
inline constexpr int kSplitCount = 5;
std::string_view split_name(Split split);

/// A cell predicted by a fit that did (in_sample) or did not see it.
struct HeldOut {
  std::size_t cell = 0;
  std::string fold;  ///< what was left out: "dragon"; empty in sample
  double predicted_ms = 0.0;
  double log_sd = 0.0;                 ///< standard deviation of ln(time), from parameters and residuals
  double low_ms = 0.0, high_ms = 0.0;  ///< 90 % interval
  std::vector<double> gradient;        ///< d ln(time) / d ln(parameter); none from simple rules
};

/// Two cells of one table, scene, GPU, light and stage with other techniques: how many times as long the
/// second takes. Who chooses a technique asks for this, not for times.
struct HeldOutRatio {
  std::size_t first = 0, second = 0;  ///< cells
  std::string fold;                   ///< what was left out for both: "dragon"
  double predicted = 1.0, published = 1.0;
  double log_sd = 0.0;           ///< standard deviation of ln(ratio)
  double low = 1.0, high = 1.0;  ///< 90 % interval
};

struct RatioFigures {
  std::size_t pairs = 0;
  double median_ape_pct = 0.0;
  double coverage90_pct = 0.0;
  double width_ratio = 1.0;  ///< median of high / low
};

struct Worst {
  std::size_t cell = 0;
  double ape_pct = 0.0;
};

struct Figures {
  std::size_t cells = 0;
  double mape_pct = 0.0, median_ape_pct = 0.0;
  std::optional<Worst> worst;
  double kendall = 1.0;
  double coverage90_pct = 0.0;
  double width_ratio = 1.0;  ///< median of high / low of the 90 % intervals
};

struct SplitResult {
  Split split = Split::in_sample;
  std::vector<HeldOut> cells;
  double quantile90 = 0.0;  ///< 90 % quantile of |ln(predicted / published)| / log_sd: intervals of this kind
  Figures figures;
  std::map<std::string, Figures> baselines;  ///< mean, bytes_over_bandwidth, linear_regression
  std::vector<HeldOutRatio> ratios;
  double ratio_quantile90 = 0.0;  ///< as quantile90, of ratios
  RatioFigures ratio_figures;
};

/// Where the fit without a fold ended: the logarithms of the experiment's parameters. Split::in_sample has
/// one, with an empty fold: the fit to all cells.
struct FoldOptimum {
  Split split = Split::in_sample;
  std::string fold;
  std::vector<double> log_values;
};

struct Validation {
  Fit fit;                          ///< to all cells
  std::vector<FoldOptimum> optima;  ///< optimum of every fit
  std::vector<SplitResult> splits;
  double ratio_log_sd = 0.0;  ///< spread of ln(ratio) of two techniques that the parameters do not explain
  std::map<std::string, Figures> papers, gpus;  ///< in sample
  double shaded_samples_mape_pct = 0.0, memory_worst_pct = 0.0;
  std::size_t shaded_samples_cells = 0, memory_cells = 0;
};

/// Fits to all, then to each complement of a fold, from the optimum of all. Where `known` holds a fold's
/// optimum, and it still is one within kSameCost, one evaluation there takes the place of the fit; otherwise
/// the fit begins there.
Validation validate(const Experiment& experiment, const FitOptions& options, const StepProgress& progress,
                    const std::vector<FoldOptimum>& known = {});

/// Predictions of every cell that a replay predicts, derived rows included, by one fit; intervals with the
/// given quantile.
std::vector<HeldOut> predict_cells(const Experiment& experiment, const Fit& fit, double quantile90, int jobs);

Figures figures_of(const Experiment& experiment, const std::vector<HeldOut>& cells);

/// Cells of one group are compared with each other: table, scene, GPU, view, light and stage.
std::string rank_group(const Cell& cell);

/// What a cell's run counts itself: shaded samples of its passes, or allocated MiB.
double counted(const Experiment& experiment, const Replay& replay, std::size_t cell);

}  // namespace hwsim::cost_models
