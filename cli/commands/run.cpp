#include <cstdio>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/commands/report_file.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/run_view.h"
#include "lab/base/files.h"
#include "lab/base/json_text.h"
#include "lab/base/text.h"

namespace hwsim::cli {
namespace {

/// The lab's answer; the manifest of a run that broke a law of hwsim is printed, to be attached to a report.
lab::Run simulate(Lab& lab, const RunPlan& plan, RunRecord& record, ShownRun& shown) try {
  return lab.run(plan, &shown);
} catch (const InternalError&) {
  std::fprintf(stderr, "%s", json_text(record.manifest("failed")).c_str());
  throw;
}

void suggest_next(const RunPlan& plan, const std::string& place, bool reportable, Context& context) {
  if (plan.images && plan.reference_samples == 0)
    context.suggest("the same with --reference, for the error of the images");
  else if (reportable)
    context.suggest("hwsim report " + shell_word(place));
}

}  // namespace

ExitStatus run(const RunArguments& options, Context& context) {
  check_report_place(options.report, options.common.force);
  InterruptGuard guard;
  Lab lab(lab_options(options, context.log));
  const RunPlan plan = plan_of(options, lab);
  context.log.say(plan_text(plan, options.common.jobs, lab.expected_seconds(plan)));
  RunRecord record(options.out, {plan, plan_key(plan, options.common.jobs), context.arguments,
                                 RunRecord::Layout::automatic, options.common.jobs});
  guard.remove_on_interrupt(record.partial());
  ShownRun shown(record, context.log);
  const lab::Run run = simulate(lab, plan, record, shown);
  Answer answer = shown.answer(run);
  if (run.results.size() > 1) write_file(record.path("summary.csv"), to_csv(answer.table));
  const std::string place = record.commit(context.log.text());
  guard.keep();

  const nlohmann::ordered_json json = to_json(run);
  answer.json = &json;
  print(answer, options.common);
  context.log.say("results: " + place);
  write_report(lab, options.report, context, [&] { return lab.report({place}); });
  suggest_next(plan, place, options.report.empty(), context);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
