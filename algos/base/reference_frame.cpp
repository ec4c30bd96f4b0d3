#include "algos/base/reference_frame.h"

#include "algos/base/frame_parts.h"
#include "pipeline/reference/reference_shading.h"

namespace hwsim::algos {

pipeline::Image render_reference_frame(const FrameRequest& request, const ReferenceFrameOptions& options) {
  pipeline::GroundTruthOptions truth;
  truth.width = request.width_px;
  truth.height = request.height_px;
  truth.camera = request.camera;
  truth.samples = options.samples;
  truth.jobs = options.jobs;
  truth.shadows = request.shadows;
  truth.lighting = frame_lighting(request);
  truth.progress = options.progress;
  return pipeline::render_ground_truth(*request.scene, truth);
}

}  // namespace hwsim::algos
