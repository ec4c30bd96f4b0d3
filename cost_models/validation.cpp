#include "cost_models/validation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>

#include "cost_models/baselines.h"
#include "cost_models/covariance.h"
#include "cost_models/predictor.h"
#include "cost_models/ratios.h"
#include "cost_models/statistics.h"
#include "hwsim/base/units_of_measure.h"

namespace hwsim::cost_models {
namespace {

constexpr double kCoverage = 0.9;

/// Lowest sample rate of a document's cells: what rate extrapolation trains on.
std::map<std::string, double> lowest_rates(const Experiment& experiment, const std::vector<bool>& all) {
  std::map<std::string, double> lowest;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i]) continue;
    const Cell& cell = experiment.cells[i];
    const auto [found, added] = lowest.emplace(cell.row.document, cell.rate);
    if (!added) found->second = std::min(found->second, cell.rate);
  }
  return lowest;
}

/// The fold of each cell; empty: never held out.
std::vector<std::string> folds(const Experiment& experiment, const std::vector<bool>& all, Split split) {
  const std::map<std::string, double> lowest = lowest_rates(experiment, all);
  std::vector<std::string> names(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i]) continue;
    const Cell& cell = experiment.cells[i];
    if (split == Split::leave_scene_out) names[i] = cell.scene_group;
    if (split == Split::leave_technique_out) names[i] = technique_id(cell.run.technique);
    if (split == Split::leave_gpu_out) names[i] = cell.run.gpu;
    // SSS has one rate for each technique: no lower rate of the same technique to learn from.
    if (split == Split::rate_extrapolation && cell.row.document != "SSS" &&
        cell.rate > lowest.at(cell.row.document))
      names[i] = "higher rates";
  }
  return names;
}

/// 90 % intervals; those of a fold use the residuals of the other folds, where there are others.
void set_intervals(const Experiment& experiment, SplitResult& result) {
  std::vector<double> z;
  std::vector<std::string> names;
  for (const HeldOut& c : result.cells) {
    z.push_back(std::abs(std::log(c.predicted_ms / experiment.cells[c.cell].published)) / c.log_sd);
    names.push_back(c.fold);
  }
  result.quantile90 = conformal_quantile(z, kCoverage);
  const std::map<std::string, double> by_fold = quantiles_without(names, z, kCoverage);
  for (HeldOut& c : result.cells) {
    c.low_ms = c.predicted_ms * std::exp(-by_fold.at(c.fold) * c.log_sd);
    c.high_ms = c.predicted_ms * std::exp(by_fold.at(c.fold) * c.log_sd);
  }
}

std::vector<HeldOut> predict_marked(const Experiment& experiment, const Fit& fit,
                                    const std::vector<bool>& marked, const std::string& fold, int jobs) {
  Predictor predictor(experiment, jobs, marked);
  predictor.evaluate(fit.log_values, true);
  std::vector<HeldOut> cells;
  for (std::size_t i = 0; i < marked.size(); ++i) {
    if (!marked[i]) continue;
    const double variance =
        log_variance(fit.covariance, predictor[i].gradient) + fit.residual_log_sd * fit.residual_log_sd;
    cells.push_back({i, fold, predictor[i].ms, std::sqrt(variance), 0.0, 0.0, predictor[i].gradient});
  }
  return cells;
}

class Validator {
 public:
  Validator(const Experiment& experiment, const FitOptions& options, const StepProgress& progress,
            const std::vector<FoldOptimum>& known)
      : experiment_(experiment),
        options_(options),
        progress_(progress),
        known_(known),
        all_(fitted_cells(experiment)),
        work_(simple_work(experiment)) {}

  Validation run() {
    plan();
    Validation validation;
    step("all cells");
    refit_ = options_;
    refit_.starts = 1;
    refit_.convex_first = false;  // they begin at an optimum
    refit_.progress = nullptr;
    std::optional<Fit> known = known_fit(Split::in_sample, "", all_);
    validation.fit =
        known ? std::move(*known) : fit(experiment_, all_, Predictor(experiment_, 1).start(), options_);
    optimum_ = validation.fit.log_values;
    optima_ = {{Split::in_sample, "", optimum_}};
    for (int s = 0; s < kSplitCount; ++s)
      validation.splits.push_back(split(static_cast<Split>(s), validation.fit));
    add_ratios(experiment_, validation);
    validation.optima = std::move(optima_);
    by_label(validation);
    count(validation);
    progress_(steps_, steps_, "");
    return validation;
  }

 private:
  void plan() {
    steps_ = 1;
    for (int s = 1; s < kSplitCount; ++s) {
      const auto names = folds(experiment_, all_, static_cast<Split>(s));
      std::set<std::string> different(names.begin(), names.end());
      different.erase("");
      steps_ += different.size();
    }
  }
  const std::vector<double>* known_optimum(Split split, const std::string& fold) const {
    for (const FoldOptimum& k : known_)
      if (k.split == split && k.fold == fold) return &k.log_values;
    return nullptr;
  }
  /// The known optimum, where it still is one.
  std::optional<Fit> known_fit(Split split, const std::string& fold, const std::vector<bool>& use) const {
    const std::vector<double>* known = known_optimum(split, fold);
    if (known == nullptr) return std::nullopt;
    Fit at = fit_at(experiment_, use, *known, refit_);
    return at.gain_ratio < kSameCost ? std::optional(std::move(at)) : std::nullopt;
  }
  void step(const std::string& what) { progress_(done_++, steps_, what); }

  SplitResult split(Split split, const Fit& full) {
    SplitResult result;
    result.split = split;
    std::map<std::string, std::vector<HeldOut>> baselines;
    if (split == Split::in_sample) {
      result.cells = predict_marked(experiment_, full, all_, "", options_.jobs);
      add_baselines(all_, all_, result.cells, baselines);
    } else {
      const std::vector<std::string> names = folds(experiment_, all_, split);
      std::set<std::string> different(names.begin(), names.end());
      different.erase("");
      for (const std::string& fold : different) hold_out(names, fold, split, result, baselines);
    }
    set_intervals(experiment_, result);
    result.figures = figures_of(experiment_, result.cells);
    for (const auto& [name, cells] : baselines) result.baselines[name] = figures_of(experiment_, cells);
    return result;
  }

  void hold_out(const std::vector<std::string>& names, const std::string& fold, Split split,
                SplitResult& result, std::map<std::string, std::vector<HeldOut>>& baselines) {
    std::vector<bool> train = all_, test(all_.size(), false);
    for (std::size_t i = 0; i < all_.size(); ++i)
      if (names[i] == fold) train[i] = false, test[i] = true;
    step(std::string(split_name(split)) + ": " + fold);
    std::optional<Fit> known = known_fit(split, fold, train);
    const Fit part =
        known ? std::move(*known) : fit(experiment_, train, start_of(split, fold, train), refit_);
    optima_.push_back({split, fold, part.log_values});
    const std::vector<HeldOut> cells = predict_marked(experiment_, part, test, fold, options_.jobs);
    result.cells.insert(result.cells.end(), cells.begin(), cells.end());
    add_baselines(train, test, cells, baselines);
  }

  std::vector<double> start_of(Split split, const std::string& fold, const std::vector<bool>& train) const {
    const std::vector<double>* known = known_optimum(split, fold);
    std::vector<double> start = known ? *known : optimum_;
    // Parameters that lose all their data must forget what the full fit knew.
    const std::vector<bool> used = used_parameters(experiment_, train);
    for (std::size_t k = 0; k < start.size(); ++k)
      if (!used[k]) start[k] = std::log(experiment_.parameters[k].start);
    return start;
  }

  void add_baselines(const std::vector<bool>& train, const std::vector<bool>& test,
                     const std::vector<HeldOut>& cells,
                     std::map<std::string, std::vector<HeldOut>>& baselines) {
    for (const auto& [name, predicted] : baseline_predictions(experiment_, work_, train, test))
      for (std::size_t i = 0; i < cells.size(); ++i)
        baselines[name].push_back({cells[i].cell, cells[i].fold, predicted[i], 0.0, 0.0, 0.0, {}});
  }

  void by_label(Validation& validation) const {
    std::map<std::string, std::vector<HeldOut>> papers, gpus;
    for (const HeldOut& c : validation.splits.front().cells) {
      std::string paper = experiment_.cells[c.cell].row.document;
      std::transform(paper.begin(), paper.end(), paper.begin(),
                     [](char ch) { return static_cast<char>(std::tolower(ch)); });
      papers[paper].push_back(c);
      gpus[experiment_.cells[c.cell].run.gpu].push_back(c);
    }
    for (const auto& [name, cells] : papers) validation.papers[name] = figures_of(experiment_, cells);
    for (const auto& [name, cells] : gpus) validation.gpus[name] = figures_of(experiment_, cells);
  }

  void count(Validation& validation) const {
    double sum = 0.0;
    for (const Replay& replay : experiment_.replays)
      for (const std::size_t i : replay.cells) {
        const Cell& cell = experiment_.cells[i];
        if (cell.use != RowUse::count) continue;
        const double error = percent_error(counted(experiment_, replay, i), cell.published);
        if (cell.unit == "samples") {
          sum += error;
          ++validation.shaded_samples_cells;
        } else {
          validation.memory_worst_pct = std::max(validation.memory_worst_pct, error);
          ++validation.memory_cells;
        }
      }
    if (validation.shaded_samples_cells > 0)
      validation.shaded_samples_mape_pct = sum / static_cast<double>(validation.shaded_samples_cells);
  }

  const Experiment& experiment_;
  const FitOptions& options_;
  FitOptions refit_;
  const StepProgress& progress_;
  const std::vector<FoldOptimum>& known_;
  std::vector<FoldOptimum> optima_;
  std::vector<bool> all_;
  std::vector<SimpleWork> work_;
  std::vector<double> optimum_;
  std::size_t steps_ = 0, done_ = 0;
};

}  // namespace

std::string_view split_name(Split split) {
  switch (split) {
    case Split::in_sample:
      return "in_sample";
    case Split::leave_scene_out:
      return "leave_scene_out";
    case Split::leave_technique_out:
      return "leave_technique_out";
    case Split::rate_extrapolation:
      return "rate_extrapolation";
    case Split::leave_gpu_out:
      return "leave_gpu_out";
  }
  return "in_sample";
}

Validation validate(const Experiment& experiment, const FitOptions& options, const StepProgress& progress,
                    const std::vector<FoldOptimum>& known) {
  return Validator(experiment, options, progress, known).run();
}

std::vector<HeldOut> predict_cells(const Experiment& experiment, const Fit& fit, double quantile90,
                                   int jobs) {
  std::vector<bool> all(experiment.cells.size(), false);
  for (const Replay& replay : experiment.replays)
    for (const std::size_t cell : replay.cells)
      all[cell] = experiment.cells[cell].unit == "ms" && experiment.cells[cell].row.quantity != "fps" &&
                  experiment.cells[cell].row.quantity != "speedup";
  std::vector<HeldOut> cells = predict_marked(experiment, fit, all, "", jobs);
  for (HeldOut& c : cells) {
    c.low_ms = c.predicted_ms * std::exp(-quantile90 * c.log_sd);
    c.high_ms = c.predicted_ms * std::exp(quantile90 * c.log_sd);
  }
  return cells;
}

Figures figures_of(const Experiment& experiment, const std::vector<HeldOut>& cells) {
  Figures figures;
  figures.cells = cells.size();
  std::vector<double> errors;
  std::vector<double> widths;
  std::vector<Ranked> ranked;
  double inside = 0.0;
  for (const HeldOut& c : cells) {
    const Cell& cell = experiment.cells[c.cell];
    errors.push_back(percent_error(c.predicted_ms, cell.published));
    if (!figures.worst || errors.back() > figures.worst->ape_pct) figures.worst = {c.cell, errors.back()};
    ranked.push_back({rank_group(cell), c.predicted_ms, cell.published});
    inside += c.low_ms <= cell.published && cell.published <= c.high_ms ? 1.0 : 0.0;
    if (c.low_ms > 0.0) widths.push_back(c.high_ms / c.low_ms);
  }
  if (cells.empty()) return figures;
  figures.mape_pct = mean(errors);
  figures.median_ape_pct = median(errors);
  figures.kendall = kendall(ranked);
  figures.coverage90_pct = inside / static_cast<double>(cells.size()) * 100.0;
  if (!widths.empty()) figures.width_ratio = median(std::move(widths));
  return figures;
}

std::string rank_group(const Cell& cell) {
  const PublishedRow& r = cell.row;
  return r.document + "|" + r.gpu + "|" + r.scene + "|" + r.view + "|" + r.lighting + "|" + r.pass;
}

/// The count of a technique's counter, by its id: which slot it has, techniques decide.
std::uint64_t technique_count(const WorkTrace& trace, std::string_view id) {
  const auto found = std::ranges::find(trace.technique_counters, id);
  if (found == trace.technique_counters.end())
    throw std::logic_error("the trace of " + trace.technique + " does not name the counter " +
                           std::string(id));
  const auto slot = static_cast<std::size_t>(found - trace.technique_counters.begin());
  return total(trace).technique[TechniqueCounter{slot}];
}

double counted(const Experiment& experiment, const Replay& replay, std::size_t cell) {
  if (experiment.cells[cell].unit == "mib")
    return static_cast<double>(replay.trace->allocated_memory_bytes) / kBytesPerMib;
  return static_cast<double>(technique_count(*replay.trace, "technique.lit_samples"));
}

}  // namespace hwsim::cost_models
