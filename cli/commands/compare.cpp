#include <algorithm>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
#include "lab/base/messages.h"
#include "lab/base/text.h"
#include "lab/studies/axes.h"

namespace hwsim::cli {
namespace {

Trials trials_of(const CompareArguments& options) {
  Trials trials{.overlays = options.overlays, .sets = parse_sets(options.view.sets)};
  for (const std::string& list : options.what_ifs)
    for (std::string& what_if : split(list, ',')) trials.what_ifs.push_back(std::move(what_if));
  if (!options.vary.empty())
    trials.points = PointSettings(parse_axes(options.vary), options.zip ? Combine::zip : Combine::grid).all();
  return trials;
}

Comparison simulate(const CompareArguments& options, Context& context) {
  RunArguments base = options;
  base.view.scene = options.inputs.front();
  base.view.sets.clear();
  base.overlays.clear();
  const Request request = request_of(base);
  return Lab(lab_options(options, context.log)).compare(request, variations_of(trials_of(options)));
}

}  // namespace

ExitStatus compare(const CompareArguments& options, Context& context) {
  const bool results_given = std::any_of(options.inputs.begin(), options.inputs.end(), is_result);
  if (!results_given && options.inputs.size() > 1)
    fail_usage("U004", "one scene, or the folders of several results, can be compared", "",
               "`hwsim run SCENE --out DIR` for each scene, then `hwsim compare DIR DIR`");
  const Comparison comparison = results_given
                                    ? Lab(lab_options(options, context.log)).compare_folders(options.inputs)
                                    : simulate(options, context);
  const nlohmann::ordered_json json = to_json(comparison);
  const Table matrix = variation_matrix(comparison);
  print({.table = pass_comparison(comparison, options.all),
         .heading = to_text(frame_comparison(comparison)) + "\n" +
                    (matrix.rows.empty() ? ""
                                         : "time of each technique against its own, 90 % interval\n" +
                                               to_text(matrix) + "\n"),
         .footing = options.counters ? "\n" + to_text(counter_comparison(comparison)) : std::string(),
         .json = &json},
        options.common);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
