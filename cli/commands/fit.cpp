#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/progress.h"
#include "cost_models/calibration.h"
#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/results/run_directory.h"
#include "lab/studies/published_runs.h"

namespace hwsim::cli {
namespace {

using cost_models::Experiment;
using cost_models::Fit;
using cost_models::Validation;

std::string state_of(const cost_models::Estimate& e) {
  if (!e.used) return "no data";
  if (e.at_bound) return "at bound";
  return e.identified ? "" : "not identified";
}

Table parameter_table(const Experiment& experiment, const Fit& fit) {
  Table table{{{"parameter", "parameter"},
               {"unit", "unit"},
               {"start", "start", true},
               {"low", "low", true},
               {"high", "high", true},
               {"value", "fitted", true},
               {"low90", "90 % from", true},
               {"high90", "to", true},
               {"state", "state"},
               {"meaning", "meaning", false, 60}},
              {}};
  for (std::size_t i = 0; i < experiment.parameters.size(); ++i) {
    const cost_models::Parameter& p = experiment.parameters[i];
    const cost_models::Estimate& e = fit.estimates[i];
    table.rows.push_back({p.id(), p.unit, Real{p.start, 3}, Real{p.low, 3}, Real{p.high, 3}, Real{e.value, 3},
                          Real{e.low90, 3}, Real{e.high90, 3}, state_of(e), p.meaning});
  }
  return table;
}

std::string correlations_text(const Experiment& experiment, const Fit& fit) {
  std::string text;
  for (const cost_models::CorrelatedPair& pair : fit.correlations)
    text += fmt::format("correlated {:+.2f}: {} and {}\n", pair.correlation,
                        experiment.parameters[pair.a].id(), experiment.parameters[pair.b].id());
  return text;
}

std::string starts_text(const Fit& fit) {
  const auto same =
      std::count_if(fit.starts.begin(), fit.starts.end(), [](const auto& s) { return s.same_optimum; });
  std::string text = fmt::format("{} of {} starts ended in the same optimum\n", same, fit.starts.size());
  for (std::size_t i = 0; i < fit.starts.size(); ++i)
    if (!fit.starts[i].same_optimum)
      text +=
          fmt::format("start {} ended elsewhere: cost {:.3f} after {} iterations{}\n", i, fit.starts[i].cost,
                      fit.starts[i].iterations, fit.starts[i].converged ? "" : ", not converged");
  return text;
}

std::string heading(const Fit& fit, double wall_s) {
  return fmt::format(
      "{} parameters, {} fitted values; cost {:.3f} from {:.3f}, {} after {} iterations; {:.1f} s\n"
      "residual spread {:.1f} %, condition {:.3g}\n\n",
      fit.used_parameters, fit.fitted_values, fit.cost, fit.start_cost,
      fit.converged ? "converged" : "NOT converged", fit.iterations, wall_s, fit.residual_log_sd * 100.0,
      fit.condition);
}

void write_calibration(const Experiment& experiment, const Validation& validation,
                       const FitOptions& options) {
  OutPlace out = options.out;
  if (out.directory.empty()) out.directory = "calibrated";
  RunDirectory directory(out, "fit");
  const cost_models::Calibration calibration = cost_models::make_calibration(experiment, validation);
  for (const GpuConfig& gpu : experiment.gpus)
    if (calibration.techniques.contains(gpu.id))
      write_file(directory.path(gpu.id + ".toml"), cost_models::calibrated_file(gpu, calibration));
  write_file(directory.path("calibration.json"), cost_models::to_json(calibration));
  write_file(directory.path("manifest.json"), "{\"written_by\": \"hwsim fit\"}\n");
  directory.commit();
}

}  // namespace

ExitStatus fit(const FitOptions& options, Context& context) {
  std::vector<cost_models::Cell> cells = published_cells(options.papers);
  if (options.dry_run) {
    print({.table = plan_table(cells)}, options.common);
    return ExitStatus::done;
  }
  const Experiment experiment = load_experiment(std::move(cells), options.common.jobs, context.log);
  cost_models::check_parameter_count(experiment, cost_models::fitted_cells(experiment));
  Progress progress(options.common, context.terminal);
  const auto start = std::chrono::steady_clock::now();
  cost_models::FitOptions fit_options;
  fit_options.jobs = options.common.jobs;
  fit_options.starts = options.starts;
  double fit_wall_s = 0.0;
  const Validation validation = cost_models::validate(
      experiment, fit_options, [&](std::size_t done, std::size_t all, const std::string& what) {
        if (done == 1)
          fit_wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        progress.update(static_cast<double>(done) / static_cast<double>(all), what);
      });
  progress.finish();
  write_calibration(experiment, validation, options);
  const Table not_run = not_run_table(experiment);
  print({.table = parameter_table(experiment, validation.fit),
         .heading = heading(validation.fit, fit_wall_s),
         .footing = "\n" + starts_text(validation.fit) + correlations_text(experiment, validation.fit) +
                    (not_run.rows.empty() ? "" : "\n" + to_text(not_run))},
        options.common);
  return validation.fit.converged ? ExitStatus::done : ExitStatus::run_failed;
}

}  // namespace hwsim::cli
