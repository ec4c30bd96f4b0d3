#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/progress.h"
#include "lab/base/files.h"
#include "lab/request/image_input.h"
#include "lab/results/run_files.h"
#include "lab/store/cache.h"

namespace hwsim::cli {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

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

/// A run in progress: what the points share, and what they leave behind.
class Run {
 public:
  Run(const RunOptions& options, Context& context);
  ExitStatus finish();

 private:
  void load();
  void simulate();
  void record(const PointResult& point);
  Answer answer() const;
  Json manifest_now(const std::string& state) const;
  void stage_progress(double done_ratio, const std::string& what);

  const RunOptions& options_;
  Context& context_;
  Clock::time_point start_ = Clock::now();
  InterruptGuard guard_;
  RunPlan plan_;
  std::unique_ptr<RunDirectory> directory_;
  std::unique_ptr<Progress> progress_;
  size_t stages_ = 0, stage_ = 0;

  std::unique_ptr<SceneView> scene_;
  std::optional<ReferenceImage> reference_;
  std::vector<std::vector<Cell>> rows_;
  Json results_ = Json::array();
  std::string heading_, footing_;
  Table single_;
  std::uint64_t fragments_ = 0;
  double emulation_s_ = 0.0;
};

Run::Run(const RunOptions& options, Context& context) : options_(options), context_(context) {
  plan_ = plan_of(options);
  context_.log.say(plan_text(plan_, options.common.jobs));
  directory_ = std::make_unique<RunDirectory>(options.out, plan_key(plan_, options.common.jobs));
  guard_.remove_on_interrupt(directory_->partial());
  stages_ = plan_.techniques.size() * plan_.gpus.size() + (plan_.reference_samples > 0 ? 1 : 0);
  progress_ = std::make_unique<Progress>(options.common, context_.terminal);
  load();
  try {
    simulate();
  } catch (const InternalError&) {
    progress_->finish();
    std::fprintf(stderr, "%s\n", manifest_now("failed").dump(2).c_str());
    throw;
  }
  progress_->finish();
}

void Run::stage_progress(double done_ratio, const std::string& what) {
  progress_->update((static_cast<double>(stage_) + done_ratio) / static_cast<double>(stages_), what);
}

void Run::load() {
  scene_ = std::make_unique<SceneView>(plan_.view, context_.log);
  plan_.view.resolution = scene_->plan().resolution;  // an image in place of a scene brings its own
  if (plan_.reference_samples == 0) return;
  reference_ = make_reference(*scene_, plan_.reference_samples, options_.common.jobs,
                              [this](double done, const std::string& what) { stage_progress(done, what); });
  context_.log.detail(fmt::format("reference: {}{}", duration_text(reference_->wall_s),
                                  reference_->from_cache ? ", from the cache" : ""));
  ++stage_;
}

void Run::simulate() {
  TraceStore store({.jobs = options_.common.jobs, .disk = !options_.no_cache}, context_.log);
  Simulator simulator(plan_, *scene_, reference_ ? &*reference_ : nullptr, store);
  for (const algos::TechniqueChoice& technique : plan_.techniques)
    for (const GpuConfig& gpu : plan_.gpus) {
      const std::string name = algos::technique_text(technique) + " on " + gpu.id;
      stage_progress(0.0, name);
      record(simulator.run(technique, gpu, [&](double done, const std::string& pass) {
        stage_progress(done, name + ": " + pass);
      }));
      ++stage_;
      stage_progress(0.0, name);
    }
}

void Run::record(const PointResult& point) {
  const bool alone = plan_.techniques.size() * plan_.gpus.size() == 1;
  const std::string& scene = scene_->summary().name;
  write_point_files(alone ? directory_->partial().string() : directory_->path(point_folder(point)), point,
                    plan_, scene, reference_ ? &*reference_ : nullptr);
  if (!point.from_cache) {
    fragments_ += shader_invocations(point.emulation->trace);
    emulation_s_ += point.emulation->wall_s;
  }
  rows_.push_back(summary_row(point));
  results_.push_back(result_json(point, plan_, scene));
  context_.log.detail(headline(point, plan_, scene));
  for (const Diagnostic& warning : result_warnings(point)) context_.log.report(warning);
  if (!alone) return;
  heading_ = headline(point, plan_, scene) + "\n";
  single_ = pass_table(point);
  footing_ = "\n" + to_text(unit_table(point));
}

Json Run::manifest_now(const std::string& state) const {
  return manifest({.arguments = context_.arguments,
                   .plan = &plan_,
                   .scene = scene_ ? &scene_->summary() : nullptr,
                   .wall_s = std::chrono::duration<double>(Clock::now() - start_).count(),
                   .fragments = fragments_,
                   .emulation_s = emulation_s_,
                   .state = state});
}

ExitStatus Run::finish() {
  const bool alone = results_.size() == 1;
  const Table summary = summary_table(rows_);
  if (!alone) write_file(directory_->path("summary.csv"), to_csv(summary));
  const Json manifest = manifest_now("done");
  write_file(directory_->path("manifest.json"), manifest.dump(2) + "\n");
  write_file(directory_->path("log.txt"), context_.log.text());
  directory_->commit();
  guard_.keep();
  remember_seconds(plan_key(plan_, options_.common.jobs), manifest["wall_s"]);

  const Json several = {{"schema_version", kResultSchemaVersion}, {"results", results_}};
  const std::string title = fmt::format("{} at {}x{}\n\n", scene_->summary().name,
                                        plan_.view.resolution.width_px, plan_.view.resolution.height_px);
  print({.table = alone ? single_ : summary,
         .heading = alone ? heading_ : title,
         .footing = footing_,
         .json = alone ? &results_.front() : &several},
        options_.common);
  const std::string place = directory_->final_place().string();
  context_.log.say("results: " + place);
  if (context_.terminal.error_is_terminal && plan_.reference_samples == 0)
    context_.log.say("next: repeat with --reference for the error of the images");
  return ExitStatus::done;
}

}  // namespace

ExitStatus run(const RunOptions& options, Context& context) { return Run(options, context).finish(); }

}  // namespace hwsim::cli
