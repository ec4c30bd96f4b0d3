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

/// Ray-traces the view, or takes it from the cache.
ReferenceImage make_reference(SceneView& scene, int samples, int jobs, const Cache& cache,
                              const ProgressFunction& progress);

}  // namespace hwsim::lab
