#include "lab/studies/reproduction.h"

#include <cmath>

namespace hwsim::lab {
namespace {

using cost_models::Experiment;
using cost_models::Fit;
using cost_models::HeldOut;
using cost_models::RowUse;

/// The parameters of the calibration, or the documented start with wide, unlabeled uncertainty.
Fit fit_for(const Experiment& experiment, const cost_models::Calibration* calibration, Observer& observer) {
  if (calibration)
    if (auto fit = cost_models::fit_of(*calibration, experiment.parameters)) return *fit;
  observer.say(calibration
                   ? "the calibration is of other parameters; documented values are used, without intervals"
                   : "not calibrated: documented values are used, without intervals; `hwsim fit` calibrates");
  Fit fit;
  for (const cost_models::FittedParameter& p : experiment.parameters)
    fit.log_values.push_back(std::log(p.start));
  fit.covariance.assign(fit.log_values.size() * fit.log_values.size(), 0.0);
  return fit;
}

void set_time(ReproducedRow& row, const HeldOut& prediction, const cost_models::Calibration* calibration) {
  row.predicted = prediction.predicted_ms;
  if (!calibration) return;
  row.low = prediction.low_ms;
  row.high = prediction.high_ms;
  const auto held = calibration->held_out_ms.find(row.cell.row.id());
  if (held != calibration->held_out_ms.end()) row.held_out = held->second;
}

void set_counts(Reproduction& reproduction, const Experiment& experiment) {
  for (const cost_models::Replay& replay : experiment.replays)
    for (const std::size_t cell : replay.cells)
      if (experiment.cells[cell].unit != "ms")
        reproduction.rows[cell].predicted = cost_models::counted(experiment, replay, cell);
}

std::optional<cost_models::Figures> fitted_figures(const Experiment& experiment,
                                                   const std::vector<HeldOut>& predictions) {
  std::vector<HeldOut> fitted;
  for (const HeldOut& p : predictions)
    if (experiment.cells[p.cell].use == RowUse::fitted) fitted.push_back(p);
  if (fitted.empty()) return std::nullopt;
  return cost_models::figures_of(experiment, fitted);
}

}  // namespace

Reproduction reproduce(const std::string& paper, const Experiment& experiment,
                       const cost_models::Calibration* calibration, int jobs, Observer& observer) {
  const Fit fit = fit_for(experiment, calibration, observer);
  const bool known = fit.residual_log_sd > 0.0;
  const double quantile = known ? calibration->quantile90.at("in_sample") : 0.0;
  Reproduction reproduction{.paper = paper};
  for (const cost_models::Cell& cell : experiment.cells)
    reproduction.rows.push_back({.cell = cell, .excluded_because = cell.reason});
  reproduction.predictions = cost_models::predict_cells(experiment, fit, quantile, jobs);
  for (const HeldOut& p : reproduction.predictions)
    set_time(reproduction.rows[p.cell], p, known ? calibration : nullptr);
  set_counts(reproduction, experiment);
  for (const cost_models::NotRun& n : experiment.not_run)
    reproduction.rows[n.cell].excluded_because = "not run: " + n.reason;
  reproduction.figures = fitted_figures(experiment, reproduction.predictions);
  return reproduction;
}

}  // namespace hwsim::lab
