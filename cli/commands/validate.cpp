#include <fmt/format.h>

#include <filesystem>

#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "cost_models/accuracy.h"
#include "lab/base/files.h"
#include "lab/lab.h"
#include "lab/studies/published_runs.h"
#include "lab/studies/validation_report.h"

namespace hwsim::cli {
namespace {

constexpr std::size_t kWorstCells = 10;

}  // namespace

ExitStatus validate(const ValidateOptions& options, Context& context) {
  if (options.dry_run) {
    print({.table = plan_table(published_cells(options.papers))}, options.common);
    return ExitStatus::done;
  }
  const std::vector<cost_models::Statement> statements = cost_models::load_statements(
      (std::filesystem::path(config_directory()) / "calibration" / "accuracy.csv").string());
  Lab lab({.jobs = options.common.jobs, .observer = &context.log});
  const lab::Validation answer = lab.validate(options.papers);
  const cost_models::Experiment& experiment = answer.experiment;
  const cost_models::Validation& validation = answer.figures;
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
