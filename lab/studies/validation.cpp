#include "lab/studies/validation.h"

#include <chrono>

#include "cost_models/calibration.h"
#include "lab/base/files.h"
#include "lab/base/stage_progress.h"

namespace hwsim::lab {
namespace {

using cost_models::Experiment;

Errors make_errors(const Experiment& experiment, const cost_models::Figures& f) {
  Errors errors{.cells = f.cells,
                .mape_pct = f.mape_pct,
                .median_ape_pct = f.median_ape_pct,
                .kendall = f.kendall,
                .coverage90_pct = f.coverage90_pct,
                .width_ratio = f.width_ratio};
  if (!f.worst) return errors;
  const cost_models::Cell& cell = experiment.cells[f.worst->cell];
  errors.worst = CellError{cell.row.id(), cell_name(cell), f.worst->ape_pct};
  return errors;
}

RatioErrors make_errors(const cost_models::RatioFigures& f) {
  return {.pairs = f.pairs,
          .median_ape_pct = f.median_ape_pct,
          .coverage90_pct = f.coverage90_pct,
          .width_ratio = f.width_ratio};
}

NamedValues<Errors> make_errors(const Experiment& experiment,
                                const std::map<std::string, cost_models::Figures>& figures) {
  NamedValues<Errors> errors;
  for (const auto& [name, f] : figures) errors.emplace_back(name, make_errors(experiment, f));
  return errors;
}

}  // namespace

FittedModel fit_and_validate(cost_models::Experiment experiment, const cost_models::FitOptions& options,
                             Observer& observer) {
  const auto start = std::chrono::steady_clock::now();
  const StageProgress progress(observer, 1);
  FittedModel model{std::move(experiment), {}, 0.0};
  model.figures = cost_models::validate(
      model.experiment, options, [&](std::size_t done, std::size_t all, const std::string& what) {
        if (done == 1)
          model.fit_wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        progress.update(static_cast<double>(done) / static_cast<double>(all), what);
      });
  return model;
}

Validation errors_of(std::shared_ptr<const FittedModel> model) {
  const Experiment& experiment = model->experiment;
  const cost_models::Validation& figures = model->figures;
  Validation validation{.papers = make_errors(experiment, figures.papers),
                        .gpus = make_errors(experiment, figures.gpus),
                        .shaded_samples = {figures.shaded_samples_mape_pct, figures.shaded_samples_cells},
                        .memory = {figures.memory_worst_pct, figures.memory_cells},
                        .parameters = figures.fit.used_parameters,
                        .fitted_values = figures.fit.fitted_values};
  for (const cost_models::SplitResult& split : figures.splits)
    validation.splits.push_back({std::string(cost_models::split_name(split.split)),
                                 make_errors(experiment, split.figures),
                                 make_errors(experiment, split.baselines), make_errors(split.ratio_figures)});
  for (const cost_models::NotRun& n : experiment.not_run)
    validation.not_run.push_back({experiment.cells[n.cell].row.id(), n.reason});
  validation.model = std::move(model);
  return validation;
}

/// The folder is replaced as a whole, so what says what lies in it is written, too.
constexpr const char* kCalibratedReadme = R"(# Calibrated GPUs

Written by `hwsim fit`, never by hand: `calibration.json` holds parameters, covariance and errors, each `.toml` the
fitted values of one GPU. `manifest.json` marks the folder as hwsim's.
)";

void write_calibration(const FittedModel& model, const OutPlace& place) {
  OutPlace out = place;
  if (out.directory.empty()) out.directory = "calibrated";
  RunDirectory directory(out, "fit");
  const cost_models::Calibration calibration = cost_models::make_calibration(model.experiment, model.figures);
  for (const GpuConfig& gpu : model.experiment.gpus)
    if (calibration.techniques.contains(gpu.id))
      write_file(directory.path(gpu.id + ".toml"), cost_models::calibrated_file(gpu, calibration));
  write_file(directory.path("calibration.json"), cost_models::to_json(calibration));
  write_file(directory.path("manifest.json"), "{\"written_by\": \"hwsim fit\"}\n");
  write_file(directory.path("README.md"), kCalibratedReadme);
  directory.commit();
}

}  // namespace hwsim::lab
