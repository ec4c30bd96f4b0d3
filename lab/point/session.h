#pragma once
// What the points of all studies share, loaded once and kept as long as the session lives: scenes as views
// look at them, work traces, references, GPU files and
// the calibration.
#include <memory>
#include <span>
#include <vector>

#include "lab/base/stage_progress.h"
#include "lab/catalog/config_files.h"
#include "lab/point/run_sink.h"

namespace hwsim::lab {

class Session;

/// While it lives, the frames of these plans share passes. One that is made meanwhile does nothing.
class SharedFrames {
 public:
  /// Plans that look at another view than the first end the list. Throws InputError where its scene cannot be
  /// read.
  SharedFrames(std::span<const RunPlan> plans, Session& session);
  ~SharedFrames();
  SharedFrames(const SharedFrames&) = delete;
  SharedFrames& operator=(const SharedFrames&) = delete;

 private:
  Session& session_;
  bool active_;
};

class Session {
 public:
  /// `observer`, which takes the place of the options' own, must outlive the session.
  Session(const LabOptions& options, Observer& observer)
      : jobs_(options.jobs),
        observer_(observer),
        files_(ConfigFolder(options.config_folder)),
        cache_(options.cache_folder, options.cache_limit_bytes),
        traces_({.jobs = options.jobs,
                 .disk = options.use_cache,
                 .shared_passes_bytes = options.shared_passes_bytes},
                cache_, observer) {}

  Observer& observer() const { return observer_; }
  int jobs() const { return jobs_; }
  const Cache& cache() const { return cache_; }
  TraceStore& traces() { return traces_; }
  ImageErrors& image_errors() { return image_errors_; }
  ConfigFiles& files() { return files_; }

  /// Valid as long as the session. Throws InputError where the scene cannot be read.
  SceneView& scene(const View& view);
  /// Gives the memory of all scenes back; they are loaded again when they are asked for.
  void release_scenes();

  /// Ray-traced at the first call; valid as long as the session.
  const ReferenceImage& reference(SceneView& scene, int samples, const ProgressFunction& progress);

  /// Runs every technique of the plan on every GPU, in this order. Throws InputError, before anything is
  /// drawn where a pair cannot run and `sink` takes no failures, and InternalError when an invariant is
  /// violated.
  void run(const RunPlan& plan, RunSink& sink, StageProgress& progress);

  /// The stages of run(): the points, and the reference where there is one.
  static std::size_t stages(const RunPlan& plan);

 private:
  /// Throws InputError with what keeps techniques of the plan from running on its GPUs.
  void require_possible(const RunPlan& plan, SceneView& scene);

  friend class SharedFrames;

  struct KeptReference {
    const SceneView* scene = nullptr;
    int samples = 0;
    ReferenceImage image;
  };

  int jobs_;
  Observer& observer_;
  ConfigFiles files_;
  Cache cache_;
  TraceStore traces_;
  bool shares_frames_ = false;
  ImageErrors image_errors_{jobs_};
  SceneShelf shelf_;
  std::vector<std::unique_ptr<SceneView>> scenes_;
  std::vector<std::unique_ptr<KeptReference>> references_;
};

/// "msaa4x on gtx980".
std::string point_name(const algos::TechniqueChoice& technique, const GpuConfig& gpu);

}  // namespace hwsim::lab
