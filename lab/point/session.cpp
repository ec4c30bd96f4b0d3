#include "lab/point/session.h"

namespace hwsim::lab {

std::string point_name(const algos::TechniqueChoice& technique, const GpuConfig& gpu) {
  return algos::technique_text(technique) + " on " + gpu.id;
}

SharedFrames::SharedFrames(std::span<const RunPlan> plans, Session& session)
    : session_(session), active_(!session.shares_frames_) {
  if (!active_ || plans.empty()) return;
  SceneView& scene = session.scene(plans.front().view);
  const RunPlan& first = plans.front();
  std::vector<TraceStore::WantedFrame> frames;
  for (const RunPlan& plan : plans) {
    if (&session.scene(plan.view) != &scene) break;
    for (const algos::TechniqueChoice& technique : plan.techniques)
      for (const GpuConfig& gpu : plan.gpus) frames.push_back({&technique, &gpu});
  }
  if (frames.size() > 1)
    session.traces().expect(scene, frames, {first.skip, first.images || first.reference_samples > 0});
  session.shares_frames_ = true;
}

SharedFrames::~SharedFrames() {
  if (!active_) return;
  session_.traces().expect_nothing();
  session_.shares_frames_ = false;
}

SceneView& Session::scene(const View& view) {
  for (const auto& scene : scenes_)
    if (scene->plan() == view) return *scene;
  scenes_.push_back(std::make_unique<SceneView>(view, cache_, observer_, &shelf_));
  return *scenes_.back();
}

void Session::release_scenes() {
  for (const auto& scene : scenes_) scene->release();
}

const ReferenceImage& Session::reference(SceneView& scene, int samples, const ProgressFunction& progress) {
  for (const auto& kept : references_)
    if (kept->scene == &scene && kept->samples == samples) return kept->image;
  references_.push_back(std::make_unique<KeptReference>(
      KeptReference{&scene, samples, make_reference(scene, samples, {cache_, observer_, jobs_, progress})}));
  return references_.back()->image;
}

std::size_t Session::stages(const RunPlan& plan) {
  return plan.techniques.size() * plan.gpus.size() + (plan.reference_samples > 0 ? 1 : 0);
}

void Session::require_possible(const RunPlan& plan, SceneView& scene) {
  std::vector<Diagnostic> problems;
  for (const algos::TechniqueChoice& technique : plan.techniques)
    for (const GpuConfig& gpu : plan.gpus)
      for (Diagnostic& found : traces_.problems(scene, technique, gpu, {plan.skip, plan.images})) {
        found.notes.push_back("in " + point_name(technique, gpu));
        problems.push_back(std::move(found));
      }
  keep_first(problems);
  if (!problems.empty()) throw InputError(std::move(problems));
}

void Session::run(const RunPlan& given, RunSink& sink, StageProgress& progress) {
  RunPlan plan = given;
  SceneView& scene = this->scene(plan.view);
  plan.view.resolution = scene.plan().resolution;
  if (!sink.takes_failures()) require_possible(plan, scene);
  const ReferenceImage* reference = nullptr;
  if (plan.reference_samples > 0) {
    reference = &this->reference(scene, plan.reference_samples,
                                 [&](double done, const std::string& what) { progress.update(done, what); });
    progress.next("reference");
  }
  const RunContext run{plan, scene.summary(), reference};
  sink.begin(run);
  Simulator simulator(plan, scene, traces_);
  if (reference) simulator.compare_with(*reference, image_errors_);
  const SharedFrames shared(std::span(&plan, 1), *this);
  for (const algos::TechniqueChoice& technique : plan.techniques)
    for (const GpuConfig& gpu : plan.gpus) {
      const std::string name = point_name(technique, gpu);
      progress.update(0.0, name);
      std::optional<PointResult> point;
      try {
        point = simulator.run(technique, gpu, [&](double done, const std::string& pass) {
          progress.update(done, name + ": " + pass);
        });
      } catch (const InputError& error) {
        sink.failed(technique, gpu, error);
      }
      if (point) sink.point(*point, run);
      progress.next(name);
    }
}

}  // namespace hwsim::lab
