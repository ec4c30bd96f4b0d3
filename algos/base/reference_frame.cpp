#include "algos/base/reference_frame.h"

#include "algos/base/frame_parts.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/emulate/transfer.h"
#include "pipeline/memory/gpu_image.h"
#include "pipeline/reference/reference_shading.h"

namespace hwsim::algos {
namespace {

/// The frame's shadow map as its shaders read it, and in `lighting` how they look it up. Null where the frame
/// has none.
std::shared_ptr<const pipeline::Image> emulate_shadow_map(const FrameRequest& request, int jobs,
                                                          pipeline::LightingUniforms& lighting) {
  pipeline::FrameGraph graph(request.scene, request.width_px, request.height_px);
  const FrameParts parts = prepare_frame(graph, request);
  if (!parts.shadow_map) return nullptr;
  lighting = parts.lighting;
  graph.keep_passes();
  // A frame shows a color image; nobody looks at this one.
  const pipeline::ImageId shown = graph.add_image({"shown", Format::rgba8_unorm, 1, 1, 1});
  graph.add_clear("clear", {shown});
  graph.set_output(shown);

  auto map = std::make_shared<pipeline::Image>();
  pipeline::EmulationOptions options;
  options.jobs = jobs;
  options.inspect = [&](const pipeline::Pass& pass, std::span<const pipeline::GpuImage* const> images) {
    if (pass.depth != parts.shadow_map) return;
    pipeline::GpuImage depth = *images[static_cast<std::size_t>(parts.shadow_map.index)];
    depth.use_all(jobs);
    *map = pipeline::to_linear_image(depth, depth.format, jobs);
  };
  pipeline::emulate(graph, request.features, request.functional, options);
  return map;
}

}  // namespace

pipeline::Image render_reference_frame(const FrameRequest& request, const ReferenceFrameOptions& options) {
  pipeline::GroundTruthOptions truth;
  truth.width = request.width_px;
  truth.height = request.height_px;
  truth.camera = request.camera;
  truth.samples = options.samples;
  truth.jobs = options.jobs;
  truth.shadows = request.shadows;
  truth.lighting = frame_lighting(request);
  if (options.shadows == ReferenceShadows::map)
    truth.shadow_map = emulate_shadow_map(request, options.jobs, *truth.lighting);
  truth.progress = options.progress;
  return pipeline::render_ground_truth(*request.scene, truth);
}

}  // namespace hwsim::algos
