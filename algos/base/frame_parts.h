#pragma once
// What techniques share: camera, lights, shadow map, lists of draws, and the forward pass.
#include <memory>
#include <string>
#include <vector>

#include "algos/base/shaders/forward.h"
#include "algos/base/technique.h"
#include "pipeline/state/sample_pattern.h"

namespace hwsim::algos {

/// Draws by how they are rendered.
struct DrawLists {
  std::vector<pipeline::DrawCall> opaque;
  std::vector<pipeline::DrawCall> mask;   ///< alpha-tested
  std::vector<pipeline::DrawCall> blend;  ///< back to front
  std::vector<pipeline::DrawCall> wires;  ///< back to front; only where wire anti-aliasing is asked for
};

struct FrameParts {
  const FrameRequest* request = nullptr;
  pipeline::Camera camera;
  glm::mat4 clip_from_world{1.0f};
  DrawLists draws;
  bool full_varyings = false;  ///< some mesh has tangents or vertex colors
  pipeline::LightingUniforms lighting;
  pipeline::ImageId shadow_map;  ///< none without a shadow caster
};

/// The scene's lights and the point lights of the request, without a shadow map: what the ray-traced
/// reference of the same frame is lit by.
pipeline::LightingUniforms frame_lighting(const FrameRequest& request);

/// Adds the shadow map's passes, if there is a caster, and gathers the rest. Point lights of the request are
/// added.
FrameParts prepare_frame(pipeline::FrameGraph& graph, const FrameRequest& request);

/// Where a pixel is covered in part, its center may lie outside of the primitive, and what is interpolated
/// there is extrapolated: normals of fine meshes then point beyond all that the surface shows.
inline constexpr ParameterInfo kCentroid{
    "centroid", 1, 0, 1, "attributes inside the primitive at partly covered pixels", "off|on"};

/// A target of a forward pass.
struct ForwardTarget {
  pipeline::ImageId color, depth;
  int width = 0, height = 0, samples = 1;
  bool centroid = false, sample_rate = false;
  int coverage_samples = 0;   ///< more than `samples`: with a coverage map (techniques 1.6)
  bool drop_orphans = false;  ///< see Pass::drop_orphans
  glm::vec2 jitter_px{0.0f};  ///< samples move by this (x right, y down), so geometry moves against it
  /// Of the layers of a multicast target; no viewports: one layer, standard positions.
  pipeline::MulticastPattern layers;
};

/// Background and depth cleared, then everything drawn: opaque, alpha-tested, blended.
void add_forward(pipeline::FrameGraph& graph, const FrameParts& parts, const std::string& prefix,
                 const ForwardTarget& target);

/// What goes over lit color: wires where wire anti-aliasing is asked for, then draws of blended materials,
/// depth tested and not written.
void add_blended(pipeline::FrameGraph& graph, const FrameParts& parts, const std::string& name,
                 const ForwardTarget& target);

/// The same onto a finished image of one sample a pixel, when the frame's depth has more: opaque draws are
/// repeated for a depth of its own. Adds nothing where nothing is blended.
void add_blended_on_output(pipeline::FrameGraph& graph, const FrameParts& parts, pipeline::ImageId output);

/// Depth-stencil image and color image in the frame's size times `scale`.
ForwardTarget make_forward_target(pipeline::FrameGraph& graph, const std::string& name, int width, int height,
                                  int samples, Format color = Format::rgba8_srgb,
                                  Format depth = Format::d24_unorm_s8,
                                  const pipeline::MulticastPattern& layers = {});

/// Values of a parameter `emulate`: sample counts beyond the GPU's by viewport multicast, or not.
inline constexpr std::string_view kEmulateChoices = "auto|on|off";
/// The layers of eight samples that make `samples`; none where they are native, or to be.
pipeline::MulticastPattern multicast_layers(const FrameRequest& request, int samples, int emulate);

/// A pass of `program` over the whole of `target`.
pipeline::Pass& add_full_screen(pipeline::FrameGraph& graph, const std::string& name,
                                std::vector<pipeline::ImageId> sampled, pipeline::ImageId target,
                                const pipeline::FragmentProgram& program,
                                std::shared_ptr<const void> uniforms);

/// The final image: rgba8_srgb, 1x.
pipeline::ImageId add_output(pipeline::FrameGraph& graph);

/// Camera matrix with sub-pixel jitter (techniques 1.2).
glm::mat4 jittered(const glm::mat4& clip_from_world, glm::vec2 jitter_px, int width, int height);

pipeline::PipelineState opaque_state(const ForwardTarget& target);

}  // namespace hwsim::algos
