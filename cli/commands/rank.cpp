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
#include "lab/request/request_words.h"
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

/// A view that --vary names, and what its files are called.
struct RankedView {
  RunPlan plan;
  std::string name;
};

std::string name_of(const std::vector<Assignment>& settings) {
  std::string name;
  for (const Assignment& set : settings) name += (name.empty() ? "" : "-") + set.path + "-" + set.value;
  for (char& c : name)
    if (c == '/' || c == ':' || c == ',' || c == '=') c = '_';
  return name;
}

std::vector<RankedView> views_of(const RankArguments& options, Lab& lab) {
  const PointSettings settings(parse_axes(options.vary), options.zip ? Combine::zip : Combine::grid);
  const Request base = request_of(with_defaults(options));
  std::vector<RankedView> views;
  std::vector<Diagnostic> problems;
  for (const std::vector<Assignment>& view : settings.all()) {
    for (const Assignment& set : view)
      if (!is_of_frame(set.path))
        fail_usage("U004", "`" + set.path + "` is no part of a view", "",
                   "--vary of scene, camera, resolution or scene.*; -g takes several GPUs");
    Request request = base;
    apply(request, view, problems);
    views.push_back({ranking_plan(lab.plan(request, problems)), name_of(view)});
  }
  if (!problems.empty()) throw InputError(problems);
  return views;
}

std::string plan_text(const std::vector<RankedView>& views) {
  const RunPlan& plan = views.front().plan;
  std::string text =
      fmt::format("plan: {}, {} techniques on {}, {}x{}, reference of {} samples a pixel", plan.view.scene,
                  plan.techniques.size(), plan.gpus.front().id, plan.view.resolution.width_px,
                  plan.view.resolution.height_px, plan.reference_samples);
  if (views.size() * plan.gpus.size() > 1)
    text += fmt::format("; {} views on {} GPUs", views.size(), plan.gpus.size());
  return text;
}

std::string error_text(const Ranking& ranking, const RankedTechnique& technique) {
  const char* where = ranking.edges ? " at edges" : "";
  if (ranking.metric == "psnr") return fmt::format("PSNR{} {:.2f} dB", where, -technique.error);
  if (ranking.metric == "ssim") return fmt::format("SSIM {:.4f}", technique.ssim);
  return fmt::format("FLIP{} {:.4f}", where, technique.error);
}

std::string sentence(const Ranking& ranking) {
  const RankedTechnique& best = ranking.techniques.front();
  if (!may_be_within(best.verdict)) return "no technique stays within the budget\n\n";
  return fmt::format("{} has the least error{}: {}, {:+.3f} ms and {:+.1f} MiB beyond no anti-aliasing{}\n\n",
                     best.technique, ranking.budget.empty() ? "" : " within the budget",
                     error_text(ranking, best), best.aa_ms, best.extra_mib,
                     best.verdict == "ok" ? "" : ", " + best.verdict);
}

std::string sentence(const std::vector<OverallTechnique>& techniques, const std::vector<Ranking>& rankings) {
  const OverallTechnique& best = techniques.front();
  const std::string where = fmt::format("all {} rankings", rankings.size());
  if (!may_be_within(best.verdict)) return "no technique stays within the budget in " + where + "\n\n";
  return fmt::format(
      "{} has the least error in {}{}: {:+.3f} ms and {:+.1f} MiB beyond no anti-aliasing at most{}\n\n",
      best.technique, where, rankings.front().budget.empty() ? "" : " within the budget", best.aa_ms_most,
      best.extra_mib_most, best.verdict == "ok" ? "" : ", " + best.verdict);
}

/// One ranking is answered as itself, several as one table with what techniques are over all of them.
void print_rankings(const std::vector<Ranking>& rankings, const CommonArguments& common) {
  const nlohmann::ordered_json json = rankings.size() == 1 ? to_json(rankings.front()) : to_json(rankings);
  if (rankings.size() == 1) {
    print({.table = ranking_table(rankings.front()),
           .heading = sentence(rankings.front()),
           .footing = {},
           .json = &json,
           .one_screen = true},
          common);
    return;
  }
  const std::vector<OverallTechnique> all = overall(rankings);
  print({.table = joined_table(rankings),
         .heading = sentence(all, rankings) + to_text(overall_table(all)) + "\n",
         .footing = {},
         .json = &json,
         .one_screen = true},
        common);
}

void write_files(const std::vector<Ranking>& rankings, const std::vector<RankedView>& views,
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
  const std::vector<RankedView> views = views_of(options, lab);
  std::vector<RunPlan> plans;
  for (const RankedView& view : views) plans.push_back(view.plan);
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
