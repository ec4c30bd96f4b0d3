#include "cli/terminal/run_view.h"

#include <fmt/format.h>

#include "cli/terminal/progress.h"
#include "lab/request/image_input.h"

namespace hwsim::cli {

std::string plan_text(const RunPlan& plan, int jobs, std::optional<double> seconds) {
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
  if (seconds) text += fmt::format("; {} the last time", duration_text(*seconds));
  return text;
}

void ShownRun::begin(const RunContext& run) {
  record_.begin(run);
  if (run.reference)
    log_.detail(fmt::format("reference: {}{}", duration_text(run.reference->wall_s),
                            run.reference->from_cache ? ", from the cache" : ""));
}

void ShownRun::point(const PointResult& point, const RunContext& run) {
  record_.point(point, run);
  const std::string sentences =
      headline(make_result(point, run.plan, run.scene.name), limiter_share_ratio(point));
  log_.detail(sentences);
  for (const Diagnostic& warning : result_warnings(point)) log_.report(warning);
  last_ = {.table = pass_table(point),
           .heading = sentences + "\n",
           .footing = Passage("\n").add(unit_table(point)),
           .one_screen = true};
}

Answer ShownRun::answer(const lab::Run& run) const {
  if (run.results.size() == 1) return last_;
  return {
      .table = summary_table(run.results),
      .heading = fmt::format("{} at {}x{}\n\n", run.scene, run.resolution.width_px, run.resolution.height_px),
      .one_screen = true};
}

}  // namespace hwsim::cli
