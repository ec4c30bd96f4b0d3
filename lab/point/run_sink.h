#pragma once
// Who is told of the points of a run while they come. A point brings its images with it: whoever needs them
// takes them here, since the lab keeps only results.
#include "lab/point/simulate.h"

namespace hwsim::lab {

/// What the points of a run share.
struct RunContext {
  const RunPlan& plan;  ///< an image in place of a scene has set the resolution
  const SceneSummary& scene;
  const ReferenceImage* reference = nullptr;  ///< null: none was asked for
};

class RunSink {
 public:
  RunSink() = default;
  RunSink(const RunSink&) = delete;
  RunSink& operator=(const RunSink&) = delete;
  virtual ~RunSink() = default;

  /// Called once, before the first point.
  virtual void begin(const RunContext& run) { (void)run; }
  virtual void point(const PointResult& point, const RunContext& run) = 0;

  /// Whether failed() takes a technique that cannot run on a GPU. Where it does not, the whole run is refused
  /// before anything is drawn.
  virtual bool takes_failures() const { return false; }

  /// The technique cannot run on the GPU; called while `error` is handled. Unless somebody takes it, the run
  /// ends here.
  virtual void failed(const algos::TechniqueChoice& technique, const GpuConfig& gpu,
                      const InputError& error) {
    (void)technique, (void)gpu, (void)error;
    throw;
  }
};

}  // namespace hwsim::lab
