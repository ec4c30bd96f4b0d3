#include <fmt/format.h>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/commands/report_file.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/interrupt.h"
#include "lab/base/files.h"
#include "lab/base/json_text.h"
#include "lab/base/text.h"
#include "lab/results/run_record.h"
#include "pipeline/image/image_io.h"

namespace hwsim::cli {
namespace {

RunArguments with_defaults(const RankArguments& options) {
  RunArguments run = options;
  if (run.techniques.empty()) run.techniques = rankable_techniques();
  if (!run.reference_samples) run.reference_samples = kDefaultReferenceSamples;
  return run;
}

std::string plan_text(const RunPlan& plan) {
  return fmt::format("plan: {}, {} techniques on {}, {}x{}, reference of {} samples a pixel", plan.view.scene,
                     plan.techniques.size(), plan.gpus.front().id, plan.view.resolution.width_px,
                     plan.view.resolution.height_px, plan.reference_samples);
}

bool may_be_within(const std::string& verdict) {
  return verdict == "ok" || verdict == "unknown" || verdict == "at risk";
}

std::string sentence(const Ranking& ranking) {
  const RankedTechnique& best = ranking.techniques.front();
  if (!may_be_within(best.verdict)) return "no technique stays within the budget\n\n";
  return fmt::format(
      "{} has the least error{}: FLIP {:.4f}, {:+.3f} ms and {:+.1f} MiB beyond no anti-aliasing{}\n\n",
      best.technique, ranking.budget.empty() ? "" : " within the budget", best.flip_mean, best.aa_ms,
      best.extra_mib, best.verdict == "ok" ? "" : ", " + best.verdict);
}

}  // namespace

ExitStatus rank(const RankArguments& options, Context& context) {
  if (!options.budget.empty()) parse_budget(options.budget);  // a mistake in it comes first
  check_report_place(options.report, options.common.force);
  Lab lab(lab_options(options, context.log));
  const RunPlan plan = ranking_plan(plan_of(with_defaults(options), lab));
  context.log.say(plan_text(plan));
  InterruptGuard guard;
  RunRecord record(options.out, {plan, plan.view.scene + options.budget, context.arguments,
                                 RunRecord::Layout::folder_a_point, options.common.jobs});
  guard.remove_on_interrupt(record.partial());
  pipeline::Image sheet;
  const Ranking ranking = lab.rank(plan, options.budget, &record, &sheet);

  const Table table = ranking_table(ranking);
  const nlohmann::ordered_json json = to_json(ranking);
  if (plan.images) pipeline::write_image(sheet, record.path("contact_sheet.png"));
  write_file(record.path("ranking.csv"), to_csv(table));
  write_file(record.path("ranking.json"), json_text(json));
  const std::string place = record.commit(context.log.text());
  guard.keep();
  print({.table = table, .heading = sentence(ranking), .footing = {}, .json = &json, .one_screen = true},
        options.common);
  context.log.say("results: " + place);
  write_report(lab, options.report, context, [&] { return lab.report({place}); });
  if (options.report.empty()) context.suggest("hwsim report " + shell_word(place));
  return may_be_within(ranking.techniques.front().verdict) ? ExitStatus::done : ExitStatus::check_not_met;
}

}  // namespace hwsim::cli
