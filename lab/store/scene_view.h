#pragma once
// A scene as a plan looks at it. What the answers need of it (name, content hash, cameras, the loader's
// notes) is remembered on disk beside the stamps of its files, so that a run whose traces are cached never
// loads it. An image that stands for a scene has neither geometry nor cameras, and sets the resolution.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "algos/techniques.h"
#include "lab/base/observer.h"
#include "lab/request/plan.h"
#include "lab/store/cache.h"
#include "lab/store/scene_shelf.h"
#include "pipeline/image/image_io.h"

namespace hwsim::lab {

struct SceneSummary {
  std::string name;
  std::string content_hash;
  std::vector<std::string> cameras;
  std::vector<Diagnostic> notes;
  std::vector<pipeline::SpecialSurface> surfaces;
  std::uint64_t triangles = 0;  ///< that a frame draws, were all of them in view
};

/// The name of a camera that is given by its name or index. Throws InputError U009 where the scene has none.
std::string camera_name(const SceneSummary& scene, const std::string& camera);

class SceneView {
 public:
  /// Finds the camera by name or index, or makes one of words (free_camera.h). `cache` and `shelf`, which is
  /// where other views' scenes are found, must outlive the view. Throws InputError.
  SceneView(View plan, const Cache& cache, Observer& observer, SceneShelf* shelf = nullptr);

  const View& plan() const { return plan_; }
  const SceneSummary& summary() const { return summary_; }
  int camera() const { return camera_; }

  /// Loaded at the first call.
  const std::shared_ptr<const pipeline::Scene>& scene();

  /// Gives the scene's memory back; it is loaded again when it is asked for.
  void release();

  /// All that loading the scene depends on: views with one text share their scene.
  std::string load_text() const;

  /// The frame without a GPU: features and limits are still to be set.
  algos::FrameRequest frame_request();

 private:
  void load();
  void load_image();
  int adopt_camera();

  View plan_;
  const Cache& cache_;
  SceneShelf* shelf_;
  SceneSummary summary_;
  std::optional<pipeline::Camera> free_camera_;  ///< none: one of the scene's
  int camera_ = 0;
  std::shared_ptr<const pipeline::Scene> scene_;
  std::shared_ptr<const pipeline::RawImage> image_;  ///< stands for the scene, which is empty then
};

}  // namespace hwsim::lab
