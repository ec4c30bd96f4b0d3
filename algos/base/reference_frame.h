#pragma once
// The ground truth of a frame: rays instead of rasterization, the same materials, lights and shadow map.
#include <cstdint>
#include <functional>

#include "algos/base/technique.h"
#include "pipeline/image/image.h"

namespace hwsim::algos {

/// What shadows the reference has. A shadow map's texels err more than any anti-aliasing: by the frame's own
/// map all techniques are measured against the shading that they sample, and rays show what the map costs.
enum class ReferenceShadows : std::uint8_t { map, rays };

struct ReferenceFrameOptions {
  int samples = 64;  ///< a pixel
  int jobs = 1;
  ReferenceShadows shadows = ReferenceShadows::map;
  std::function<void(double share)> progress{};
};

pipeline::Image render_reference_frame(const FrameRequest& request, const ReferenceFrameOptions& options);

}  // namespace hwsim::algos
