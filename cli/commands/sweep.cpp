#include <fmt/format.h>

#include <filesystem>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/commands/report_file.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/interrupt.h"
#include "lab/base/messages.h"
#include "lab/studies/axes.h"

namespace hwsim::cli {
namespace {

PointSettings settings_of(const SweepArguments& options) {
  std::vector<Axis> axes = parse_axes(options.vary);
  if (options.sample && options.zip)
    fail_usage("U019", "--zip and --sample exclude each other", "", "one of them");
  if (options.sample) return {std::move(axes), parse_sample(*options.sample), options.seed};
  return {std::move(axes), options.zip ? Combine::zip : Combine::grid};
}

SweepJob job_of(const SweepArguments& options, const std::vector<std::string>& arguments) {
  SweepJob job{.database = options.database,
               .resume = options.resume,
               .force = options.out.force,
               .shard = options.shard ? parse_shard(*options.shard) : Shard{},
               .merge = options.merge,
               .command_line = {}};
  for (const std::string& word : arguments) job.command_line += (job.command_line.empty() ? "" : " ") + word;
  return job;
}

}  // namespace

ExitStatus sweep(const SweepArguments& options, Context& context) {
  const bool has_scene = !options.view.scene.empty();
  const SweepJob job = job_of(options, context.arguments);
  if (!has_scene && options.merge.empty() && !std::filesystem::exists(options.database))
    fail_usage("U002", "no scene, and no database `" + options.database + "` to print", "",
               "`hwsim sweep --help` shows examples");
  check_report_place(options.report, options.common.force);
  Lab lab(lab_options(options, context.log));
  SweepPlan plan;
  if (has_scene) {
    plan = lab.plan_sweep(request_of(options), settings_of(options));
    context.log.say(
        fmt::format("plan: {}, {} points, database {}", options.view.scene, plan.size(), options.database));
  }
  if (options.dry_run) {
    print_rows(planned_rows(plan), options.common);
    return ExitStatus::done;
  }
  InterruptGuard guard("interrupted: finished points are kept, --resume goes on with the others");
  const SweepSummary summary = lab.sweep(plan, job);
  print_rows(summary.points, options.common);
  context.log.say(fmt::format("{} points done, {} failed, {} left, in {}", summary.done, summary.failed,
                              summary.left, summary.database));
  write_report(lab, options.report, context, [&] { return lab.report({options.database}); });
  return summary.failed > 0 ? ExitStatus::some_points_failed : ExitStatus::done;
}

}  // namespace hwsim::cli
