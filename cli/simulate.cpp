#include "cli/simulate.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <chrono>

#include "cli/cache.h"
#include "cli/calibration_files.h"
#include "cli/messages.h"
#include "pipeline/scene/scene_source.h"

namespace hwsim::cli {
namespace {

int find_camera(const pipeline::Scene& scene, const std::string& text) {
  const auto count = static_cast<int>(scene.cameras.size());
  int index = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  std::vector<std::string> names;
  for (const pipeline::Camera& camera : scene.cameras) names.push_back(camera.name);
  for (int i = 0; i < count; ++i)
    if (names[static_cast<size_t>(i)] == text) return i;
  if (error == std::errc() && end == text.data() + text.size() && index >= 0 && index < count) return index;
  fail("U009", fmt::format("scene `{}` has no camera `{}`", scene.name, text), did_you_mean(text, names),
       fmt::format("cameras: index 0 to {}; names: {}", count - 1, fmt::join(names, ", ")));
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

LoadedScene load_view(const ViewPlan& view) {
  LoadedScene loaded;
  loaded.scene = std::make_shared<const pipeline::Scene>(
      pipeline::open_scene(view.scene, cache_directory(CacheFolder::scenes)));
  loaded.camera = find_camera(*loaded.scene, view.camera);
  return loaded;
}

algos::FrameRequest frame_request(const ViewPlan& view, const LoadedScene& loaded) {
  algos::FrameRequest request;
  request.scene = loaded.scene;
  request.width_px = view.resolution.width_px;
  request.height_px = view.resolution.height_px;
  request.camera = loaded.camera;
  request.point_lights = view.point_lights;
  request.lights = view.lights;
  request.shadows = view.shadows;
  request.shadow_map_px = view.shadow_map_px;
  return request;
}

Simulator::Simulator(const RunPlan& plan, LoadedScene loaded, const ReferenceImage* reference, int jobs)
    : plan_(plan), loaded_(std::move(loaded)), reference_(reference), jobs_(jobs) {}

std::shared_ptr<const pipeline::Emulation> Simulator::emulate(const algos::TechniqueChoice& technique,
                                                              const GpuConfig& gpu,
                                                              const ProgressFunction& progress,
                                                              bool& reused) {
  const std::string key = algos::technique_text(technique, true) + "@" + functional_hash(gpu);
  reused = key == last_key_;
  if (reused) return last_emulation_;
  algos::FrameRequest request = frame_request(plan_.view, loaded_);
  request.features = gpu.features;
  request.functional = gpu.functional;
  const pipeline::FrameGraph graph = algos::build_frame(technique, request);
  pipeline::EmulationOptions options;
  options.jobs = jobs_;
  options.skip = plan_.skip;
  options.progress = progress;
  last_emulation_ = std::make_shared<const pipeline::Emulation>(
      pipeline::emulate(graph, gpu.features, gpu.functional, options));
  last_key_ = key;
  return last_emulation_;
}

void Simulator::measure_image(PointResult& point) {
  if (!reference_) return;
  point.image_error = pipeline::compare(point.emulation->color, reference_->image, &point.flip_map);
}

PointResult Simulator::run(const algos::TechniqueChoice& technique, const GpuConfig& gpu,
                           const ProgressFunction& progress) {
  PointResult point;
  point.technique = &technique;
  point.gpu = &gpu;
  point.emulation = emulate(technique, gpu, progress, point.emulation_reused);
  const auto start = std::chrono::steady_clock::now();
  point.timing = time_frame(point.emulation->trace, gpu, plan_.engine, plan_.timing);
  point.timing_wall_s = seconds_since(start);
  check_invariants(point.emulation->trace, point.timing, gpu);
  add_interval(point.timing, point.emulation->trace, gpu, algos::technique_text(technique));
  measure_image(point);
  return point;
}

void check_invariants(const WorkTrace& trace, const FrameTiming& timing, const GpuConfig& gpu) {
  std::string violations;
  for (const PassWork& pass : trace.passes) {
    std::array<CounterViolation, 64> storage;
    for (const CounterViolation& v : check_conservation(total(pass), storage))
      violations += fmt::format("\n  pass {}: {} ({} against {})", pass.name, v.law, v.left, v.right);
  }
  for (const std::string& sentence : check_timing(timing, trace, gpu)) violations += "\n  " + sentence;
  if (!violations.empty())
    throw InternalError(
        fmt::format("technique {} on {} violates invariants:{}", trace.technique, gpu.id, violations));
}

}  // namespace hwsim::cli
