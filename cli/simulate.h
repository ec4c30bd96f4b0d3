#pragma once
// One point of a plan: a technique executed on a scene and timed on a GPU.
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "cli/plan.h"
#include "pipeline/image/image_io.h"
#include "pipeline/image/metrics.h"

namespace hwsim::cli {

/// A law that hwsim itself broke. Not the user's mistake: exit status 1, and the manifest is printed to
/// attach.
class InternalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct LoadedScene {
  std::shared_ptr<const pipeline::Scene> scene;
  int camera = 0;
  std::shared_ptr<const pipeline::RawImage> image;  ///< stands for the scene, which is empty then
};

/// Loads the scene and finds the camera by name or index. Throws InputError.
LoadedScene load_view(const ViewPlan& view);

/// The frame without a GPU: features and limits are still to be set.
algos::FrameRequest frame_request(const ViewPlan& view, const LoadedScene& loaded);

struct ReferenceImage {
  pipeline::Image image;
  int samples = 0;
  double wall_s = 0.0;
  bool from_cache = false;
};

using ProgressFunction = std::function<void(double done_ratio, const std::string& what)>;

/// Ray-traces the view, or takes it from the cache.
ReferenceImage make_reference(const ViewPlan& view, const LoadedScene& loaded, int samples, int jobs,
                              const ProgressFunction& progress);

struct PointResult {
  const algos::TechniqueChoice* technique = nullptr;
  const GpuConfig* gpu = nullptr;
  std::shared_ptr<const pipeline::Emulation> emulation;
  bool emulation_reused = false;  ///< an earlier point of this run emulated the same work
  FrameTiming timing;
  double timing_wall_s = 0.0;
  std::optional<pipeline::ImageError> image_error;
  pipeline::Image flip_map;  ///< empty without a reference
};

/// Runs the points of one plan; GPUs that share a functional configuration share an emulation.
class Simulator {
 public:
  Simulator(const RunPlan& plan, LoadedScene loaded, const ReferenceImage* reference, int jobs);
  /// Throws InputError, or InternalError when an invariant is violated.
  PointResult run(const algos::TechniqueChoice& technique, const GpuConfig& gpu,
                  const ProgressFunction& progress);

 private:
  std::shared_ptr<const pipeline::Emulation> emulate(const algos::TechniqueChoice& technique,
                                                     const GpuConfig& gpu, const ProgressFunction& progress,
                                                     bool& reused);
  void measure_image(PointResult& point);

  const RunPlan& plan_;
  LoadedScene loaded_;
  const ReferenceImage* reference_;
  int jobs_;
  std::string last_key_;
  std::shared_ptr<const pipeline::Emulation> last_emulation_;
};

/// The invariants of every run; throws InternalError with all that are violated.
void check_invariants(const WorkTrace& trace, const FrameTiming& timing, const GpuConfig& gpu);

}  // namespace hwsim::cli
