#include <fmt/format.h>

#include <algorithm>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
#include "lab/base/text.h"
#include "lab/results/results.h"

namespace hwsim::cli {
namespace {

constexpr double kPercent = 100.0;

/// What one sentence can say: where the time goes, and what would help.
std::string verdict(const Explanation& explanation) {
  if (explanation.headroom.empty()) return "";
  const UnitHeadroomResult& best = explanation.headroom.front();
  const double gain = -relative_change(explanation.analyzed_ms, best.time_ms).value_or(0.0);
  std::string text =
      fmt::format("{} holds the frame back most: without its work it would be {:.1f} % shorter", best.unit,
                  kPercent * gain);
  const auto helps = std::ranges::find_if(explanation.sensitivities,
                                          [](const SensitivityResult& s) { return s.elasticity != 0.0; });
  if (helps != explanation.sensitivities.end())
    text += fmt::format("; the strongest lever is {} ({:+.2f} % of time a percent)", helps->parameter,
                        helps->elasticity);
  return text + "\n";
}

void add(Passage& passage, const Explanation& explanation) {
  passage.add(headline(explanation.result, limiter_share_ratio(explanation)) + verdict(explanation) + "\n");
  passage.add(explained_passes(explanation)).add("\n").add(headroom_table(explanation)).add("\n");
}

/// Rows of all points under one header, the point first where there are several.
Table joined(const std::vector<Explanation>& explanations, bool every) {
  Table table = sensitivity_table(explanations.front(), every);
  if (explanations.size() == 1) return table;
  table.rows.clear();
  table.columns.insert(table.columns.begin(), {"point", "point"});
  for (const Explanation& explanation : explanations)
    for (std::vector<TableCell>& row : sensitivity_table(explanation, every).rows) {
      row.insert(row.begin(), label_of(explanation));
      table.rows.push_back(std::move(row));
    }
  return table;
}

/// The command that tries twice the strongest number of the first point's GPU; empty where it has none.
std::string lever(const Explanation& explanation, const ExplainArguments& options) {
  const auto strongest = std::ranges::find_if(explanation.sensitivities, [](const SensitivityResult& s) {
    return s.elasticity < 0.0 && s.parameter.starts_with("gpu.");
  });
  if (strongest == explanation.sensitivities.end() || options.view.scene.empty()) return {};
  return fmt::format("hwsim compare {} -t {} -g {} --set {}=x2", shell_word(options.view.scene),
                     shell_word(explanation.result.technique), shell_word(explanation.result.gpu),
                     strongest->parameter);
}

}  // namespace

ExitStatus explain(const ExplainArguments& options, Context& context) {
  Lab lab(lab_options(options, context.log));
  const std::vector<Explanation> explanations = lab.explain(plan_of(options, lab));
  Passage heading, footing;
  for (const Explanation& explanation : explanations) add(heading, explanation);
  if (explanations.size() > 1) {
    const Comparison compared = lab::compare(explanations, lab.calibration());
    footing.add("\n").add(frame_comparison(compared)).add("\n").add(pass_comparison(compared));
  }
  const nlohmann::ordered_json json = to_json(explanations, lab.calibration());
  print({.table = joined(explanations, options.all),
         .heading = heading,
         .footing = footing,
         .json = &json,
         .one_screen = !options.all},
        options.common);
  if (const std::string command = lever(explanations.front(), options); !command.empty())
    context.suggest(command);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
