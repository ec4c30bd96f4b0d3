#include <algorithm>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/commands/report_file.h"
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

Request base_request(const CompareArguments& options) {
  RunArguments base = options;
  base.view.scene = options.inputs.front();
  base.view.sets.clear();
  base.overlays.clear();
  return request_of(base);
}

}  // namespace

ExitStatus compare(const CompareArguments& options, Context& context) {
  const bool results_given = std::any_of(options.inputs.begin(), options.inputs.end(), is_result);
  if (!results_given && options.inputs.size() > 1)
    fail_usage("U004", "one scene, or the folders of several results, can be compared", "",
               "`hwsim run SCENE --out DIR` for each scene, then `hwsim compare DIR DIR`");
  check_report_place(options.report, options.common.force);
  Lab lab(lab_options(options, context.log));
  const Request request = results_given ? Request{} : base_request(options);
  const std::vector<Variation> variations =
      results_given ? std::vector<Variation>() : variations_of(trials_of(options));
  const Comparison comparison =
      results_given ? lab.compare_folders(options.inputs) : lab.compare(request, variations);
  const nlohmann::ordered_json json = to_json(comparison);
  const Table matrix = variation_matrix(comparison);
  Passage heading, footing;
  heading.add(frame_comparison(comparison)).add("\n");
  if (!matrix.rows.empty())
    heading.add("time of each technique against its own, 90 % interval\n").add(matrix).add("\n");
  if (options.counters) footing.add("\n").add(counter_comparison(comparison));
  print({.table = pass_comparison(comparison, options.all),
         .heading = heading,
         .footing = footing,
         .json = &json,
         .one_screen = !options.all && !options.counters},
        options.common);
  write_report(lab, options.report, context, [&] {
    return results_given ? lab.report(options.inputs) : lab.report(request, variations, comparison);
  });
  return ExitStatus::done;
}

}  // namespace hwsim::cli
