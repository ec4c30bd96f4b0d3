#include <fmt/format.h>

#include <algorithm>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
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

std::string text_of(const Explanation& explanation) {
  return headline(explanation.result, limiter_share_ratio(explanation)) + verdict(explanation) + "\n" +
         to_text(explained_passes(explanation)) + "\n" + to_text(headroom_table(explanation)) + "\n";
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

}  // namespace

ExitStatus explain(const ExplainArguments& options, Context& context) {
  Lab lab(lab_options(options, context.log));
  const std::vector<Explanation> explanations = lab.explain(plan_of(options, lab));
  std::string heading, footing;
  for (const Explanation& explanation : explanations) heading += text_of(explanation);
  if (explanations.size() > 1) {
    const Comparison compared = lab::compare(explanations, lab.calibration());
    footing = "\n" + to_text(frame_comparison(compared)) + "\n" + to_text(pass_comparison(compared));
  }
  const nlohmann::ordered_json json = to_json(explanations, lab.calibration());
  print({.table = joined(explanations, options.all), .heading = heading, .footing = footing, .json = &json},
        options.common);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
