#include <fmt/format.h>

#include <filesystem>

#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/progress.h"
#include "cost_models/accuracy.h"
#include "lab/base/files.h"
#include "lab/studies/published_runs.h"
#include "lab/studies/validation_report.h"

namespace hwsim::cli {
namespace {

constexpr std::size_t kWorstCells = 10;

}  // namespace

ExitStatus validate(const ValidateOptions& options, Context& context) {
  std::vector<cost_models::Cell> cells = published_cells(options.papers);
  if (options.dry_run) {
    print({.table = plan_table(cells)}, options.common);
    return ExitStatus::done;
  }
  const std::vector<cost_models::Statement> statements = cost_models::load_statements(
      (std::filesystem::path(config_directory()) / "calibration" / "accuracy.csv").string());
  const cost_models::Experiment experiment =
      load_experiment(std::move(cells), options.common.jobs, context.log);
  Progress progress(options.common, context.terminal);
  cost_models::FitOptions fit_options;
  fit_options.jobs = options.common.jobs;
  const cost_models::Validation validation = cost_models::validate(
      experiment, fit_options, [&](std::size_t done, std::size_t all, const std::string& what) {
        progress.update(static_cast<double>(done) / static_cast<double>(all), what);
      });
  progress.finish();
  const nlohmann::ordered_json json = validation_json(experiment, validation);
  const Table not_run = not_run_table(experiment);
  const std::string counts = fmt::format(
      "counts: shaded samples {:.1f} % off in the mean ({} rows), memory {:.2f} % at worst ({} rows)\n"
      "{} parameters, {} fitted values\n",
      validation.shaded_samples_mape_pct, validation.shaded_samples_cells, validation.memory_worst_pct,
      validation.memory_cells, validation.fit.used_parameters, validation.fit.fitted_values);
  print({.table = split_table(experiment, validation),
         .footing = "\n" + to_text(label_table(experiment, validation)) + "\n" +
                    to_text(worst_table(experiment, validation, kWorstCells)) + "\n" + counts +
                    (not_run.rows.empty() ? "" : "\n" + to_text(not_run)),
         .json = &json},
        options.common);
  const std::vector<std::string> broken =
      cost_models::broken_statements(statements, validation, options.papers);
  for (const std::string& sentence : broken) context.log.say("accuracy: " + sentence);
  return broken.empty() ? ExitStatus::done : ExitStatus::check_not_met;
}

}  // namespace hwsim::cli
