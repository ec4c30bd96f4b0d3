#include <fmt/format.h>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/interrupt.h"
#include "lab/results/run_record.h"
#include "pipeline/image/image_io.h"

namespace hwsim::cli {
namespace {

RunPlan reference_plan(const ReferenceArguments& options) {
  RunPlan plan;
  plan.view = view_of(options.view);
  plan.reference_samples = options.samples;
  plan.overrides = parse_sets(options.view.sets);
  return plan;
}

Table answer_table(const std::string& scene, const ReferenceImage& reference, const std::string& place) {
  return {{{"scene", "scene"},
           {"samples", "samples a pixel", true},
           {"wall_s", "seconds", true},
           {"from_cache", "from cache"},
           {"image", "image"}},
          {{scene, static_cast<std::uint64_t>(reference.samples), Real{reference.wall_s, 2},
            reference.from_cache ? "yes" : "no", place + "/reference.png"}}};
}

}  // namespace

ExitStatus reference(const ReferenceArguments& options, Context& context) {
  InterruptGuard guard;
  const RunPlan plan = reference_plan(options);
  context.log.say(fmt::format("plan: reference of {}, {} samples a pixel, {}x{}, {} threads", plan.view.scene,
                              options.samples, plan.view.resolution.width_px, plan.view.resolution.height_px,
                              options.common.jobs));
  RunRecord record(options.out, {plan, plan.view.scene, context.arguments});
  guard.remove_on_interrupt(record.partial());
  Lab lab(lab_options(options.common, context.log));
  const ReferenceImage& image = lab.reference(plan.view, options.samples);
  const SceneSummary& scene = lab.scene(plan.view);
  record.begin({plan, scene, &image});
  pipeline::write_image(image.image, record.path("reference.png"));
  pipeline::write_image(image.image, record.path("reference.exr"));
  const std::string place = record.commit(context.log.text());
  guard.keep();
  print({.table = answer_table(scene.name, image, place)}, options.common);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
