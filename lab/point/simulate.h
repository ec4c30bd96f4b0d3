#pragma once
// One point of a plan: a technique executed on a scene and timed on a GPU.
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "cost_models/intervals.h"
#include "lab/base/internal_error.h"
#include "lab/point/image_errors.h"
#include "lab/store/reference_image.h"
#include "lab/store/trace_store.h"
#include "pipeline/image/metrics.h"

namespace hwsim::lab {

struct PointResult {
  const algos::TechniqueChoice* technique = nullptr;
  const GpuConfig* gpu = nullptr;
  std::vector<pipeline::SpecialSurface> surfaces{};  ///< special ones of the scene
  std::shared_ptr<const pipeline::Emulation> emulation;
  bool from_cache = false;  ///< an earlier point, or an earlier run, emulated the same work
  FrameTiming timing;
  cost_models::ErrorSources error_sources{};
  double timing_wall_s = 0.0;
  std::optional<pipeline::ImageError> image_error;
  std::shared_ptr<const pipeline::Image> flip_map{};  ///< null without a reference
};

/// Runs the points of one plan; GPUs that share a functional configuration share an emulation.
class Simulator {
 public:
  Simulator(const RunPlan& plan, SceneView& scene, TraceStore& store)
      : plan_(plan), scene_(scene), store_(store) {}
  /// Points have errors of their images then. Both must outlive the simulator.
  void compare_with(const ReferenceImage& reference, ImageErrors& errors) {
    reference_ = &reference;
    errors_ = &errors;
  }
  /// Throws InputError, or InternalError when an invariant is violated.
  PointResult run(const algos::TechniqueChoice& technique, const GpuConfig& gpu,
                  const ProgressFunction& progress);

 private:
  const RunPlan& plan_;
  SceneView& scene_;
  TraceStore& store_;
  const ReferenceImage* reference_ = nullptr;
  ImageErrors* errors_ = nullptr;
};

/// Times the point's work on its GPU as the plan says, with the interval where the calibration knows the GPU.
/// Throws InternalError when an invariant is violated. In any thread.
void time_point(PointResult& point, const RunPlan& plan);

/// The invariants of every timing; throws InternalError with all that are violated.
void check_times(const WorkTrace& trace, const FrameTiming& timing, const GpuConfig& gpu);

}  // namespace hwsim::lab
