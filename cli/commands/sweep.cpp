#include <fmt/format.h>

#include <filesystem>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/interrupt.h"
#include "lab/base/messages.h"
#include "lab/studies/axes.h"

namespace hwsim::cli {
namespace {

std::vector<std::vector<Assignment>> settings_of(const SweepOptions& options) {
  const std::vector<Axis> axes = parse_axes(options.vary);
  return options.sample ? latin_hypercube(axes, parse_sample(*options.sample), options.seed)
                        : combine(axes, options.zip ? Combine::zip : Combine::grid);
}

SweepJob job_of(const SweepOptions& options, const std::vector<std::string>& arguments) {
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

ExitStatus sweep(const SweepOptions& options, Context& context) {
  const bool has_scene = !options.view.scene.empty();
  const SweepJob job = job_of(options, context.arguments);
  if (!has_scene && options.merge.empty() && !std::filesystem::exists(options.database))
    fail_usage("U002", "no scene, and no database `" + options.database + "` to print", "",
               "`hwsim sweep --help` shows examples");
  Lab lab(lab_options(options, context.log));
  std::vector<PlannedPoint> points;
  if (has_scene) {
    const std::vector<std::vector<Assignment>> settings = settings_of(options);
    points = lab.plan_sweep(request_of(options), settings);
    context.log.say(
        fmt::format("plan: {}, {} points, database {}", options.view.scene, points.size(), options.database));
  }
  if (options.dry_run) {
    print({.table = has_scene ? planned_table(points) : Table{}}, options.common);
    return ExitStatus::done;
  }
  InterruptGuard guard("interrupted: finished points are kept, --resume goes on with the others");
  const SweepSummary summary = lab.sweep(points, job);
  print({.table = summary.points}, options.common);
  context.log.say(fmt::format("{} points done, {} failed, {} left, in {}", summary.done, summary.failed,
                              summary.left, summary.database));
  return summary.failed > 0 ? ExitStatus::some_points_failed : ExitStatus::done;
}

}  // namespace hwsim::cli
