#include <fmt/format.h>

#include <cstdio>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/progress.h"
#include "lab/base/files.h"
#include "lab/request/image_input.h"
#include "lab/results/run_record.h"
#include "lab/store/cache.h"

namespace hwsim::cli {
namespace {

std::string plan_key(const RunPlan& plan, int jobs) {
  std::string key = fmt::format("{}|{}x{}|{}|{}|{}|{}|{}", plan.view.scene, plan.view.resolution.width_px,
                                plan.view.resolution.height_px, plan.view.point_lights, plan.view.lights,
                                plan.reference_samples, plan.images, jobs);
  for (const auto& technique : plan.techniques) key += "|" + algos::technique_text(technique, true);
  for (const GpuConfig& gpu : plan.gpus) key += "|" + gpu.id;
  return key;
}

std::string plan_text(const RunPlan& plan, int jobs) {
  const size_t points = plan.techniques.size() * plan.gpus.size();
  std::string text = fmt::format(
      "plan: {}, {} x {} = {}, {}, engine {}, {} threads", plan.view.scene,
      plan.techniques.size() == 1 ? "1 technique" : fmt::format("{} techniques", plan.techniques.size()),
      plan.gpus.size() == 1 ? "1 GPU" : fmt::format("{} GPUs", plan.gpus.size()),
      points == 1 ? "1 point" : fmt::format("{} points", points),
      is_image_file(plan.view.scene)
          ? "the image's size"
          : fmt::format("{}x{}", plan.view.resolution.width_px, plan.view.resolution.height_px),
      engine_name(plan.engine), jobs);
  if (plan.reference_samples > 0)
    text += fmt::format(", reference of {} samples a pixel", plan.reference_samples);
  if (const auto seconds = remembered_seconds(plan_key(plan, jobs)))
    text += fmt::format("; {} the last time", duration_text(*seconds));
  return text;
}

/// Records the points, logs them, and keeps what the answer shows of a single one.
class ShownRun : public RunSink {
 public:
  ShownRun(RunRecord& record, Log& log) : record_(record), log_(log) {}

  void begin(const RunContext& run) override {
    record_.begin(run);
    if (run.reference)
      log_.detail(fmt::format("reference: {}{}", duration_text(run.reference->wall_s),
                              run.reference->from_cache ? ", from the cache" : ""));
  }

  void point(const PointResult& point, const RunContext& run) override {
    record_.point(point, run);
    answer.heading = headline(make_result(point, run.plan, run.scene.name), limiter_share_ratio(point));
    log_.detail(answer.heading);
    for (const Diagnostic& warning : result_warnings(point)) log_.report(warning);
    answer.heading += "\n";
    answer.table = pass_table(point);
    answer.footing = "\n" + to_text(unit_table(point));
  }

  Answer answer;  ///< the last point's

 private:
  RunRecord& record_;
  Log& log_;
};

/// The lab's answer; the manifest of a run that broke a law of hwsim is printed, to be attached to a report.
lab::Run simulate(const RunPlan& plan, const RunOptions& options, RunRecord& record, ShownRun& shown,
                  Log& log) try {
  return Lab(lab_options(options, log)).run(plan, &shown);
} catch (const InternalError&) {
  std::fprintf(stderr, "%s\n", record.manifest("failed").dump(2).c_str());
  throw;
}

Answer several_points(const lab::Run& run) {
  return {.table = summary_table(run.results),
          .heading =
              fmt::format("{} at {}x{}\n\n", run.scene, run.resolution.width_px, run.resolution.height_px)};
}

}  // namespace

ExitStatus run(const RunOptions& options, Context& context) {
  InterruptGuard guard;
  const RunPlan plan = plan_of(options);
  const std::string key = plan_key(plan, options.common.jobs);
  context.log.say(plan_text(plan, options.common.jobs));
  RunRecord record(options.out, {plan, key, context.arguments});
  guard.remove_on_interrupt(record.partial());
  ShownRun shown(record, context.log);
  const lab::Run run = simulate(plan, options, record, shown, context.log);
  Answer answer = run.results.size() == 1 ? shown.answer : several_points(run);
  if (run.results.size() > 1) write_file(record.path("summary.csv"), to_csv(answer.table));
  const std::string place = record.commit(context.log.text());
  guard.keep();
  remember_seconds(key, record.wall_s());

  const nlohmann::ordered_json json = to_json(run);
  answer.json = &json;
  print(answer, options.common);
  context.log.say("results: " + place);
  if (context.terminal.error_is_terminal && plan.reference_samples == 0)
    context.log.say("next: repeat with --reference for the error of the images");
  return ExitStatus::done;
}

}  // namespace hwsim::cli
