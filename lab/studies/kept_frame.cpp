#include "lab/studies/kept_frame.h"

#include "hwsim/base/units_of_measure.h"
#include "hwsim/engines/sensitivity.h"
#include "hwsim/gpu/gpu_keys.h"
#include "hwsim/gpu/gpu_rules.h"
#include "hwsim/timing/time_slopes.h"
#include "lab/base/messages.h"

namespace hwsim::lab {
namespace {

void require_work_of(const KeptFrame& frame, const GpuConfig& gpu) {
  if (!is_work_of(frame, gpu))
    fail("U040", "the frame was drawn for the features of `" + frame.plan.gpus.front().id + "`, and `" +
                     gpu.id + "` has others");
}

PointResult timed(const KeptFrame& frame, const GpuConfig& gpu) {
  require_work_of(frame, gpu);
  PointResult point;
  point.technique = &frame.plan.techniques.front();
  point.gpu = &gpu;
  point.surfaces = frame.scene.surfaces;
  point.emulation = frame.emulation;
  point.from_cache = frame.from_cache;
  point.image_error = frame.image_error;
  time_point(point, frame.plan);
  return point;
}

/// The real numbers that enter the times of a GPU of this kind.
struct Reals {
  std::vector<std::string> keys;
  std::vector<double> values;
};

Reals reals_of(const GpuConfig& gpu) {
  Reals reals;
  GpuValues<double> copy = gpu;
  for (const Key& key : keys_of(copy))
    if (const auto* slot = std::get_if<double*>(&key.slot); slot && applies(key.info.name, gpu)) {
      reals.keys.emplace_back(key.info.name);
      reals.values.push_back(**slot);
    }
  return reals;
}

std::vector<KeySlope> queue_gradient(const WorkTrace& trace, const GpuConfig& gpu) {
  const Reals reals = reals_of(gpu);
  TimeSlopes slopes(gpu, reals.keys);
  const double time_ns = time_frame(trace, gpu, Engine::queue, {}, &slopes).time_ns;
  std::vector<KeySlope> gradient;
  for (std::size_t i = 0; i < reals.keys.size(); ++i) {
    const double slope_ns = slopes.ns()[i];
    gradient.push_back({reals.keys[i], reals.values[i], slope_ns / kNsPerMs,
                        time_ns > 0.0 ? slope_ns * reals.values[i] / time_ns : 0.0});
  }
  return gradient;
}

}  // namespace

KeptFrame kept_frame(const PointResult& point, const RunContext& run) {
  KeptFrame frame{.plan = run.plan, .scene = run.scene, .emulation = point.emulation};
  frame.plan.techniques = {*point.technique};
  frame.plan.gpus = {*point.gpu};
  frame.from_cache = point.from_cache;
  frame.image_error = point.image_error;
  frame.flip_map = point.flip_map;
  return frame;
}

bool is_work_of(const KeptFrame& frame, const GpuConfig& gpu) {
  return functional_hash(frame.plan.gpus.front()) == functional_hash(gpu);
}

FrameTiming timing_of(const KeptFrame& frame, const GpuConfig& gpu) { return timed(frame, gpu).timing; }

Result time(const KeptFrame& frame, const GpuConfig& gpu) {
  return make_result(timed(frame, gpu), frame.plan, frame.scene.name);
}

Explanation explain(const KeptFrame& frame, const GpuConfig& gpu) {
  return explain(timed(frame, gpu), frame.plan, frame.scene.name);
}

std::vector<KeySlope> gradient(const KeptFrame& frame, const GpuConfig& gpu) {
  require_work_of(frame, gpu);
  if (frame.plan.engine != Engine::roofline) return queue_gradient(frame.emulation->trace, gpu);
  std::vector<KeySlope> gradient;
  for (const Sensitivity& s : sensitivities(frame.emulation->trace, gpu, Engine::roofline))
    gradient.push_back({std::string(s.key), s.value, s.slope_ns / kNsPerMs, s.elasticity});
  return gradient;
}

}  // namespace hwsim::lab
