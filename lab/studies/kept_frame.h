#pragma once
// A frame that was emulated once, to be timed on many GPUs: its images, its counts, and all that a time
// needs.
#include <memory>
#include <string>
#include <vector>

#include "lab/point/run_sink.h"
#include "lab/results/result.h"
#include "lab/studies/explanation.h"

namespace hwsim::lab {

/// Cheap to copy, and valid without its lab. The functions below may run in several threads.
struct KeptFrame {
  RunPlan plan{};        ///< one technique, and the GPU for whose features it was drawn
  SceneSummary scene{};  ///< what answers need of it, without its geometry
  std::shared_ptr<const pipeline::Emulation> emulation{};  ///< without images where the plan has none
  bool from_cache = false;
  std::optional<pipeline::ImageError> image_error{};  ///< against the reference, where the plan has one
  std::shared_ptr<const pipeline::Image> flip_map{};  ///< likewise: FLIP of each pixel in r
};

/// The frame of a point that was just run.
KeptFrame kept_frame(const PointResult& point, const RunContext& run);

/// Whether the GPU has the features and limits that the frame was drawn for: only then is its work that GPU's
/// work.
bool is_work_of(const KeptFrame& frame, const GpuConfig& gpu);

// All of these draw nothing. They throw InputError U040 unless is_work_of(frame, gpu), and InternalError when
// an invariant is violated.

FrameTiming timing_of(const KeptFrame& frame, const GpuConfig& gpu);

/// The same with counts, image error and notes, as Lab::run gives it.
Result time(const KeptFrame& frame, const GpuConfig& gpu);

/// As Lab::explain.
Explanation explain(const KeptFrame& frame, const GpuConfig& gpu);

/// How the frame's time follows a real number of the GPU.
struct KeySlope {
  std::string key{};  ///< "core_clock_mhz"
  double value = 0.0;
  double slope_ms = 0.0;    ///< d(frame time) / d(value)
  double elasticity = 0.0;  ///< d(ln frame time) / d(ln value); negative: more of it is faster
};

/// Exact derivatives of the frame's time by every real number of the GPU that enters it, in the order of its
/// file. Those of engine `queue` for `detailed`, whose events have none.
std::vector<KeySlope> gradient(const KeptFrame& frame, const GpuConfig& gpu);

}  // namespace hwsim::lab
