#pragma once
// The ray-traced truth of a view, from the cache or made now.
#include "lab/store/trace_store.h"
#include "pipeline/image/image.h"

namespace hwsim::lab {

struct ReferenceImage {
  pipeline::Image image;
  int samples = 0;
  double wall_s = 0.0;
  bool from_cache = false;
};

/// With what a reference is made.
struct ReferenceContext {
  const Cache& cache;
  Observer& observer;
  int jobs = 1;
  const ProgressFunction& progress;
};

/// What a reference in the cache is: "320x180, 64 samples a pixel"; none where this version cannot read it.
std::optional<std::string> reference_title(const std::string& path, const Cache& cache);

/// Takes the view's reference from the cache, or traces its rays and keeps it there.
ReferenceImage make_reference(SceneView& scene, int samples, const ReferenceContext& context);

}  // namespace hwsim::lab
