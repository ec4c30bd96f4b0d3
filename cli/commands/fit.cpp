#include <fmt/format.h>

#include <algorithm>

#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
#include "lab/studies/published_runs.h"

namespace hwsim::cli {
namespace {

using cost_models::Experiment;
using cost_models::Fit;

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

}  // namespace

ExitStatus fit(const FitArguments& options, Context& context) {
  Lab lab(lab_options(options.common, context.log));
  if (options.dry_run) {
    print({.table = plan_table(published_cells(options.papers, lab.catalog().folder()))}, options.common);
    return ExitStatus::done;
  }
  const FittedModel model = lab.fit(options.papers, options.starts);
  write_calibration(model, options.out);
  const Fit& fit = model.figures.fit;
  const Table not_run = not_run_table(model.experiment);
  Passage footing("\n" + starts_text(fit) + correlations_text(model.experiment, fit));
  if (!not_run.rows.empty()) footing.add("\n").add(not_run);
  print({.table = parameter_table(model), .heading = heading(fit, model.fit_wall_s), .footing = footing},
        options.common);
  return fit.converged ? ExitStatus::done : ExitStatus::run_failed;
}

}  // namespace hwsim::cli
