#include "lab/point/simulate.h"

#include <fmt/format.h>

#include <array>
#include <chrono>

#include "hwsim/timing/time_slopes.h"

namespace hwsim::lab {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The part of the frame's time that each unit holds up.
std::vector<std::pair<std::string, double>> parts_by_unit(const FrameTiming& timing) {
  std::vector<std::pair<std::string, double>> parts;
  for (std::size_t u = 0; u < kUnitCount; ++u) {
    double ns = 0.0;
    for (const PassTiming& pass : timing.passes) ns += pass.stack_ns[u];
    if (ns > 0.0) parts.emplace_back(unit_name(static_cast<Unit>(u)), ns / timing.time_ns);
  }
  return parts;
}

void time_work(PointResult& point, const RunPlan& plan) {
  const WorkTrace& trace = point.emulation->trace;
  const GpuConfig& gpu = *point.gpu;
  const auto* calibration = plan.engine == Engine::queue ? plan.calibration.get() : nullptr;
  const std::string fitted_id = calibration ? cost_models::calibrated_id(*calibration, gpu) : std::string();
  if (fitted_id.empty()) {
    point.timing = time_frame(trace, gpu, plan.engine, plan.timing);
    return;
  }
  TimeSlopes slopes(gpu, cost_models::interval_keys(*calibration, fitted_id));
  point.timing = time_frame(trace, gpu, plan.engine, plan.timing, &slopes);
  cost_models::FrameInterval found = cost_models::frame_interval(
      *calibration, {point.timing.time_ns, slopes.ns()}, gpu, algos::technique_text(*point.technique));
  point.timing.support = found.support;
  point.timing.interval_ns = found.interval_ns;
  point.error_sources = {std::move(found.by_parameter), parts_by_unit(point.timing)};
}

}  // namespace

PointResult Simulator::run(const algos::TechniqueChoice& technique, const GpuConfig& gpu,
                           const ProgressFunction& progress) {
  PointResult point;
  point.technique = &technique;
  point.gpu = &gpu;
  point.surfaces = scene_.summary().surfaces;
  const EmulatedFrame frame =
      store_.frame(scene_, technique, gpu, {plan_.skip, plan_.images || reference_ != nullptr}, progress);
  point.emulation = frame.emulation;
  point.from_cache = frame.from_cache;
  time_point(point, plan_);
  if (!reference_) return point;
  const ComparedImage& compared = errors_->of(point.emulation, *reference_);
  point.image_error = compared.error;
  point.flip_map = compared.flip_map;
  return point;
}

void time_point(PointResult& point, const RunPlan& plan) {
  const auto start = std::chrono::steady_clock::now();
  time_work(point, plan);
  point.timing_wall_s = seconds_since(start);
  check_times(point.emulation->trace, point.timing, *point.gpu);
}

void check_times(const WorkTrace& trace, const FrameTiming& timing, const GpuConfig& gpu) {
  std::string violations;
  for (const std::string& sentence : check_timing(timing, trace, gpu)) violations += "\n  " + sentence;
  if (!violations.empty())
    throw InternalError(
        fmt::format("technique {} on {} violates invariants:{}", trace.technique, gpu.id, violations));
}

}  // namespace hwsim::lab
