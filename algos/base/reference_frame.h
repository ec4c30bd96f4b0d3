#pragma once
// The ground truth of a frame: rays instead of rasterization and of a shadow map, the same materials and
// lights.
#include <functional>

#include "algos/base/technique.h"
#include "pipeline/image/image.h"

namespace hwsim::algos {

struct ReferenceFrameOptions {
  int samples = 64;  ///< a pixel
  int jobs = 1;
  std::function<void(double share)> progress{};
};

pipeline::Image render_reference_frame(const FrameRequest& request, const ReferenceFrameOptions& options);

}  // namespace hwsim::algos
