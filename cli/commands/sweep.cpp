#include <fmt/format.h>

#include <filesystem>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/commands/report_file.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/interrupt.h"
#include "lab/base/files.h"
#include "lab/base/json_text.h"
#include "lab/base/messages.h"
#include "lab/studies/axes.h"
#include "lab/studies/sweep_findings.h"

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
               .alone = options.alone,
               .shard = options.shard ? parse_shard(*options.shard) : Shard{},
               .merge = options.merge,
               .command_line = {}};
  for (const std::string& word : arguments) job.command_line += (job.command_line.empty() ? "" : " ") + word;
  return job;
}

void check_modes(const SweepArguments& options, bool has_scene) {
  if ((options.emulate_only || !options.plan.empty()) && !has_scene)
    fail_usage("U002", "--plan and --emulate-only need a scene", "", "the words of the sweep");
  if (options.emulate_only && options.no_cache)
    fail_usage("U003", "--emulate-only keeps frames in the cache, and --no-cache keeps none", "",
               "one of them");
}

/// A scene that is varied need not be given: it is the first one of its axis.
SweepArguments with_scene(SweepArguments options) {
  if (options.view.scene.empty())
    for (const Axis& axis : parse_axes(options.vary))
      if (axis.path == "scene") options.view.scene = axis.values.front();
  return options;
}

std::string titled(const std::string& title, const Table& table) {
  return table.rows.empty() ? "" : "\n" + title + "\n\n" + to_text(table);
}

std::string sentence(const SweepSummary& summary, const SweepFindings& found) {
  std::string text =
      fmt::format("{} points done, {} failed, {} left", summary.done, summary.failed, summary.left);
  if (found.points == 0) return text + "\n";
  text += fmt::format(": {:.4f} to {:.4f} ms", found.fastest_ms, found.slowest_ms);
  if (found.frames > 1)
    text += fmt::format(", {} frames (times below are their geometric means)", found.frames);
  return text + "\n" + (found.best.empty() ? "" : "\nThe fastest\n\n");
}

/// What the points show together; `--rows` and other formats print every one.
void print_findings(const SweepSummary& summary, const CommonArguments& common) {
  const SweepFindings found = findings_of(summary.points);
  print({.table = choice_table(found.best),
         .heading = sentence(summary, found),
         .footing = titled("Nobody is faster and closer to the reference", choice_table(found.front)) +
                    titled("What mattered", effect_table(found.effects)) +
                    "\n`--rows` prints every point, `--format csv` with all digits\n",
         .json = nullptr},
        common);
}

/// What shards have to do, in a line each.
std::string shares(const std::vector<PlannedWork>& works, std::size_t shards) {
  const std::vector<double> seconds = expected_seconds(works, shards);
  double total = 0.0;
  for (const double s : seconds) total += s;
  std::string text = fmt::format("\n{} frames, about {:.1f} s of one core", works.size(), total);
  if (shards > 1)
    text += fmt::format("; {} shards of {:.1f} to {:.1f} s", shards, *std::ranges::min_element(seconds),
                        *std::ranges::max_element(seconds));
  return text + "\n";
}

ExitStatus write_plan(const SweepArguments& options, const SweepPlan& plan, std::size_t shards, Lab& lab) {
  std::error_code error;
  check_answer_place(options.plan);
  if (!options.out.force && std::filesystem::is_regular_file(options.plan, error))
    fail("U013", "`" + options.plan + "` exists and is not overwritten", "",
         "another file, or --force to replace it");
  const std::vector<PlannedWork> works = lab.sweep_works(plan, shards);
  write_answer(options.plan, json_text(to_json(plan, works)));
  print({.table = work_table(works), .heading = {}, .footing = shares(works, shards), .json = nullptr},
        options.common);
  return ExitStatus::done;
}

ExitStatus emulate(const SweepPlan& plan, const Shard& shard, Lab& lab, Context& context) {
  const EmulationSummary done = lab.emulate_works(plan, shard);
  context.log.say(
      fmt::format("{} frames emulated in {:.1f} s (expected {:.1f} s of one core), {} kept, {} failed, {} of "
                  "other shards",
                  done.emulated, done.wall_s, done.expected_s, done.kept, done.failed, done.others));
  return done.failed > 0 ? ExitStatus::some_points_failed : ExitStatus::done;
}

bool is_for_people(const FormatRequest& format) {
  return format.format == OutputFormat::table || format.format == OutputFormat::md;
}

void print_answer(const SweepSummary& summary, const SweepArguments& options) {
  CommonArguments findings = options.common, rows = options.common;
  if (findings.formats.empty()) findings.formats = {FormatRequest{}};
  std::erase_if(findings.formats, [&](const FormatRequest& f) { return options.rows || !is_for_people(f); });
  std::erase_if(rows.formats, [&](const FormatRequest& f) { return !options.rows && is_for_people(f); });
  if (!findings.formats.empty()) print_findings(summary, findings);
  if (options.rows || !rows.formats.empty()) print_rows(summary.points, rows);
}

}  // namespace

ExitStatus sweep(const SweepArguments& given, Context& context) {
  const SweepArguments options = with_scene(given);
  const bool has_scene = !options.view.scene.empty();
  const SweepJob job = job_of(options, context.arguments);
  if (!has_scene && options.merge.empty() && !std::filesystem::exists(options.database))
    fail_usage("U002", "no scene, and no database `" + options.database + "` to print", "",
               "`hwsim sweep --help` shows examples");
  check_modes(options, has_scene);
  check_report_place(options.report, options.common.force);
  Lab lab(lab_options(options, context.log));
  SweepPlan plan;
  if (has_scene) {
    plan = lab.plan_sweep(request_of(options), settings_of(options));
    context.log.say(
        fmt::format("plan: {}, {} points, database {}", options.view.scene, plan.size(), options.database));
  }
  if (!options.plan.empty()) return write_plan(options, plan, job.shard.count, lab);
  if (options.emulate_only) return emulate(plan, job.shard, lab, context);
  if (options.dry_run) {
    print_rows(planned_rows(plan), options.common);
    return ExitStatus::done;
  }
  InterruptGuard guard("interrupted: finished points are kept, --resume goes on with the others");
  const SweepSummary summary = lab.sweep(plan, job);
  print_answer(summary, options);
  context.log.say(fmt::format("{} points done, {} failed, {} left, in {}", summary.done, summary.failed,
                              summary.left, summary.database));
  write_report(lab, options.report, context, [&] { return lab.report({options.database}); });
  return summary.failed > 0 ? ExitStatus::some_points_failed : ExitStatus::done;
}

}  // namespace hwsim::cli
