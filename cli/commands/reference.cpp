#include <fmt/format.h>

#include <chrono>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/progress.h"
#include "lab/base/files.h"
#include "lab/results/run_directory.h"
#include "lab/results/run_files.h"
#include "pipeline/image/image_io.h"

namespace hwsim::cli {

ExitStatus reference(const ReferenceOptions& options, Context& context) {
  const auto start = std::chrono::steady_clock::now();
  InterruptGuard guard;
  RunPlan plan;
  plan.view = view_of(options.view);
  plan.reference_samples = options.samples;
  for (const std::string& text : options.view.sets) plan.overrides.push_back(parse_assignment(text));
  context.log.say(fmt::format("plan: reference of {}, {} samples a pixel, {}x{}, {} threads", plan.view.scene,
                              options.samples, plan.view.resolution.width_px, plan.view.resolution.height_px,
                              options.common.jobs));
  RunDirectory directory(options.out, plan.view.scene);
  guard.remove_on_interrupt(directory.partial());
  Progress progress(options.common, context.terminal);
  SceneView scene(plan.view, context.log);
  const ReferenceImage image =
      make_reference(scene, options.samples, options.common.jobs,
                     [&](double done, const std::string& what) { progress.update(done, what); });
  progress.finish();
  pipeline::write_image(image.image, directory.path("reference.png"));
  pipeline::write_image(image.image, directory.path("reference.exr"));
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_file(directory.path("manifest.json"), manifest({.arguments = context.arguments,
                                                        .plan = &plan,
                                                        .scene = &scene.summary(),
                                                        .wall_s = wall_s,
                                                        .state = "done"})
                                                      .dump(2) +
                                                  "\n");
  write_file(directory.path("log.txt"), context.log.text());
  directory.commit();
  guard.keep();
  const Table table{
      {{"scene", "scene"},
       {"samples", "samples a pixel", true},
       {"wall_s", "seconds", true},
       {"from_cache", "from cache"},
       {"image", "image"}},
      {{scene.summary().name, static_cast<std::uint64_t>(options.samples), Real{image.wall_s, 2},
        image.from_cache ? "yes" : "no", (directory.final_place() / "reference.png").string()}}};
  print({.table = table}, options.common);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
