#include <fmt/format.h>

#include <map>

#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
#include "cost_models/accuracy.h"
#include "lab/studies/external.h"
#include "lab/studies/published_runs.h"

namespace hwsim::cli {
namespace {

constexpr std::size_t kWorstCells = 10;

std::string counts_text(const lab::Validation& validation) {
  return fmt::format(
      "counts: shaded samples {:.1f} % off in the mean ({} rows), memory {:.2f} % at worst ({} rows)\n"
      "{} parameters, {} fitted values\n",
      validation.shaded_samples.error_pct, validation.shaded_samples.cells, validation.memory.error_pct,
      validation.memory.cells, validation.parameters, validation.fitted_values);
}

std::string not_run_text(const lab::ExternalValidation& validation) {
  std::map<std::string, std::size_t> rows;
  for (const lab::UnpredictedRow& row : validation.not_run) ++rows[row.reason];
  std::string text;
  for (const auto& [reason, count] : rows) text += fmt::format("\n{} rows not run: {}\n", count, reason);
  return text;
}

ExitStatus validate_external(const ValidateArguments& options, Lab& lab) {
  if (options.dry_run) {
    print({.table = plan_table(lab::external_cells(lab.catalog().folder()))}, options.common);
    return ExitStatus::done;
  }
  const lab::ExternalValidation validation = lab.validate_external(options.scenes);
  const nlohmann::ordered_json json = to_json(validation);
  print({.table = external_errors_table(validation),
         .footing = Passage("\n")
                        .add(external_ratios_table(validation))
                        .add("\n")
                        .add(external_rows_table(validation))
                        .add(not_run_text(validation)),
         .json = &json},
        options.common);
  return ExitStatus::done;
}

}  // namespace

ExitStatus validate(const ValidateArguments& options, Context& context) {
  Lab lab(lab_options(options.common, context.log));
  if (options.external) return validate_external(options, lab);
  const ConfigFolder& folder = lab.catalog().folder();
  if (options.dry_run) {
    print({.table = plan_table(published_cells(options.papers, folder))}, options.common);
    return ExitStatus::done;
  }
  const std::vector<cost_models::Statement> statements =
      cost_models::load_statements(folder.calibration() + "/accuracy.csv");
  const lab::Validation validation = lab.validate(options.papers);
  const nlohmann::ordered_json json = to_json(validation);
  const Table not_run = not_run_table(validation.model->experiment);
  Passage footing;
  footing.add("\n").add(ratio_table(validation)).add("\n").add(label_table(validation)).add("\n");
  footing.add(worst_table(*validation.model, kWorstCells)).add("\n" + counts_text(validation));
  if (!not_run.rows.empty()) footing.add("\n").add(not_run);
  print({.table = split_table(validation), .footing = footing, .json = &json}, options.common);
  const std::vector<std::string> broken =
      cost_models::broken_statements(statements, validation.model->figures, options.papers);
  for (const std::string& sentence : broken) context.log.say("accuracy: " + sentence);
  return broken.empty() ? ExitStatus::done : ExitStatus::check_not_met;
}

}  // namespace hwsim::cli
