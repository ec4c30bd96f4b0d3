#pragma once
// About how long emulating a frame takes, told before anything is loaded or drawn: to share work out.
#include "lab/store/scene_view.h"

namespace hwsim::lab {

/// Seconds of one core.
struct FrameCost {
  double frame_s = 0.0;
  double load_s = 0.0;  ///< loading its scene, or making it
};

/// From the passes that the technique would have, the scene's triangles and the pixels: of 32 frames 26 kept
/// its proportion within a factor of two. The same on every machine, for the same request.
FrameCost expected_cost(const SceneView& scene, const algos::TechniqueChoice& technique,
                        const GpuConfig& gpu);

}  // namespace hwsim::lab
