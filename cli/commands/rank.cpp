#include <fmt/format.h>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/commands/report_file.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/interrupt.h"
#include "lab/base/files.h"
#include "lab/base/json_text.h"
#include "lab/base/messages.h"
#include "lab/base/text.h"
#include "lab/results/run_record.h"
#include "lab/studies/axes.h"
#include "pipeline/image/image_io.h"

namespace hwsim::cli {
namespace {

RunArguments with_defaults(const RankArguments& options) {
  RunArguments run = options;
  if (run.techniques.empty()) run.techniques = rankable_techniques();
  if (!run.reference_samples) run.reference_samples = kDefaultReferenceSamples;
  return run;
}

std::vector<NamedPlan> views_of(const RankArguments& options, Lab& lab) {
  const PointSettings settings(parse_axes(options.vary), options.zip ? Combine::zip : Combine::grid);
  std::vector<NamedPlan> views = lab.plan_views(request_of(with_defaults(options)), settings);
  for (NamedPlan& view : views) view.plan = ranking_plan(std::move(view.plan));
  return views;
}

std::string plan_text(const std::vector<NamedPlan>& views) {
  const RunPlan& plan = views.front().plan;
  std::string text =
      fmt::format("plan: {}, {} techniques on {}, {}x{}, reference of {} samples a pixel", plan.view.scene,
                  plan.techniques.size(), plan.gpus.front().id, plan.view.resolution.width_px,
                  plan.view.resolution.height_px, plan.reference_samples);
  if (views.size() * plan.gpus.size() > 1)
    text += fmt::format("; {} views on {} GPUs", views.size(), plan.gpus.size());
  return text;
}

/// One ranking is answered as itself, several as one table with what techniques are over all of them.
void print_rankings(const std::vector<Ranking>& rankings, const CommonArguments& common) {
  const nlohmann::ordered_json json = rankings.size() == 1 ? to_json(rankings.front()) : to_json(rankings);
  if (rankings.size() == 1) {
    print({.table = ranking_table(rankings.front()),
           .heading = answer_of(rankings) + "\n\n",
           .footing = {},
           .json = &json,
           .one_screen = true},
          common);
    return;
  }
  print({.table = joined_table(rankings),
         .heading = answer_of(rankings) + "\n\n" + to_text(overall_table(overall(rankings))) + "\n" +
                    to_text(best_table(rankings)) + "\n",
         .footing = {},
         .json = &json,
         .one_screen = true},
        common);
}

void write_files(const std::vector<Ranking>& rankings, const std::vector<NamedPlan>& views,
                 const std::vector<pipeline::Image>& sheets, const RunRecord& record) {
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    const std::string& name = views[i].name;
    pipeline::write_image(sheets[i], record.path(name + (name.empty() ? "" : "-") + "contact_sheet.png"));
  }
  const bool alone = rankings.size() == 1;
  write_file(record.path(alone ? "ranking.csv" : "rankings.csv"),
             to_csv(alone ? ranking_table(rankings.front()) : joined_table(rankings)));
  write_file(record.path(alone ? "ranking.json" : "rankings.json"),
             json_text(alone ? to_json(rankings.front()) : to_json(rankings)));
}

}  // namespace

ExitStatus rank(const RankArguments& options, Context& context) {
  const RankQuestion question{options.budget, metric_from_name(options.metric), options.edges};
  RankingSink check(question);  // mistakes in it come first
  check_report_place(options.report, options.common.force);
  Lab lab(lab_options(options, context.log));
  const std::vector<NamedPlan> views = views_of(options, lab);
  std::vector<RunPlan> plans;
  for (const NamedPlan& view : views) plans.push_back(view.plan);
  context.log.say(plan_text(views));
  InterruptGuard guard;
  RunRecord record(options.out, {plans.front(), plans.front().view.scene + options.budget, context.arguments,
                                 RunRecord::Layout::folder_a_point, options.common.jobs});
  guard.remove_on_interrupt(record.partial());
  std::vector<pipeline::Image> sheets;
  const std::vector<Ranking> rankings =
      lab.rank_each(plans, question, &record, &sheets, [&](std::size_t view) {
        if (views.size() > 1) record.enter(views[view].name);
      });
  write_files(rankings, views, sheets, record);
  const std::string place = record.commit(context.log.text());
  guard.keep();
  print_rankings(rankings, options.common);
  context.log.say("results: " + place);
  write_report(lab, options.report, context, [&] { return lab.report({place}); });
  if (options.report.empty()) context.suggest("hwsim report " + shell_word(place));
  return may_be_within(overall(rankings).front().verdict) ? ExitStatus::done : ExitStatus::check_not_met;
}

}  // namespace hwsim::cli
