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
  std::vector<pipeline::DrawCall> mask;      ///< alpha-tested
  std::vector<pipeline::DrawCall> blend;     ///< back to front
  std::vector<pipeline::DrawCall> separate;  ///< back to front: what FrameRequest::separate takes
  /// The same in two: what is opaque in this view, and the rest.
  std::vector<pipeline::DrawCall> separate_opaque, separate_rest;
};

struct FrameParts {
  const FrameRequest* request = nullptr;
  pipeline::Camera camera;
  glm::mat4 clip_from_world{1.0f}, view_from_clip{1.0f};
  DrawLists draws;
  bool full_varyings = false;  ///< some mesh has tangents or vertex colors
  pipeline::LightingUniforms lighting;
  pipeline::ImageId shadow_map;  ///< none without a shadow caster
  /// The base draws `separate_opaque` by itself: `separate` is the rest (prepare_gbuffer_frame).
  bool separate_taken = false;
};

/// The scene's lights and the point lights of the request, without a shadow map: what the ray-traced
/// reference of the same frame is lit by.
pipeline::LightingUniforms frame_lighting(const FrameRequest& request);

/// Adds the shadow map's passes, if there is a caster, and gathers the rest. Point lights of the request are
/// added.
FrameParts prepare_frame(pipeline::FrameGraph& graph, const FrameRequest& request);

/// The option `centroid` of many techniques. Where a pixel is covered in part, its center may lie outside of
/// the primitive, and what is interpolated there is extrapolated: normals of fine meshes then point beyond
/// all that the surface shows.
void describe_centroid(OptionList& list, bool& centroid);

/// A target of a forward pass.
struct ForwardTarget {
  pipeline::ImageId color, depth;
  int width = 0, height = 0, samples = 1;
  bool centroid = false, sample_rate = false;
  int coverage_samples = 0;   ///< more than `samples`: with a coverage map (docs/techniques/forward.md)
  bool drop_orphans = false;  ///< see Pass::drop_orphans
  bool prepass = false;       ///< depth is drawn first, and what is equal shaded (prepass.h)
  glm::vec2 jitter_px{0.0f};  ///< samples move by this (x right, y down), so geometry moves against it
  /// The layers of a multicast target; no viewports: one layer, standard positions.
  pipeline::MulticastPattern layers;
};

/// What a draw hands to its fragments: nothing, or what the mesh programs of this name do.
enum class SurfaceInputs : std::uint8_t { none, normal, geometry, basic, full };

/// A draw that a modifier took, as a whole and in two.
struct SeparateCall {
  pipeline::DrawCall all, opaque, rest;  ///< without a list: nothing
};

/// Draws that a modifier takes from the bases: each base leaves them out of its own passes, and asks for
/// theirs where it has lit color. A base with a G-buffer draws by itself what is opaque.
class SeparateDraws {
 public:
  virtual ~SeparateDraws() = default;
  /// Whether a mesh part is one of them.
  virtual bool takes(const pipeline::Mesh& mesh, const pipeline::Material& material) const = 0;
  /// The draw as it stands in DrawLists: its triangles may be other lists.
  virtual SeparateCall prepare(const FrameRequest& request, const pipeline::Camera& camera,
                               pipeline::DrawCall call) const = 0;
  /// The name of their pass, after the base's prefix.
  virtual std::string pass_name() const = 0;
  /// Into lit color, with the depth of what is opaque.
  virtual std::vector<pipeline::DrawBatch> batches(const FrameParts& parts,
                                                   const ForwardTarget& target) const = 0;
  /// Their depth alone, in the shape in which `batches` draws them.
  virtual pipeline::DrawBatch depth_batch(const FrameParts& parts, const ForwardTarget& target) const = 0;
  /// What is opaque, in that shape, for fragment programs of the base's own.
  virtual pipeline::DrawBatch opaque_batch(const FrameParts& parts, SurfaceInputs inputs) const = 0;
};

/// As prepare_frame, for bases that store surfaces before they light them: `separate` is what is not opaque.
FrameParts prepare_gbuffer_frame(pipeline::FrameGraph& graph, const FrameRequest& request);
/// The batch of what was taken, if there is any: state and fragment program are those of `like`.
void add_opaque_separate(pipeline::Pass& pass, const FrameParts& parts, SurfaceInputs inputs,
                         pipeline::DrawBatch like);

/// The pass of a forward target: its viewports, attachments and the shadow map; without batches.
pipeline::Pass& add_target_pass(pipeline::FrameGraph& graph, const FrameParts& parts, const std::string& name,
                                const ForwardTarget& target);

/// Draws in the frame's view: opaque state, `vertex` with its uniforms. The fragment program is the caller's.
pipeline::DrawBatch mesh_batch(const FrameParts& parts, const std::vector<pipeline::DrawCall>& draws,
                               const pipeline::VertexProgram& vertex);
/// Hands on what materials need: the varyings of surfaces, all of them if some mesh has more than the basic.
const pipeline::VertexProgram& surface_vertex_program(const FrameParts& parts);
/// What that program hands on.
SurfaceInputs surface_inputs(const FrameParts& parts);

/// Background and depth cleared, then everything drawn: opaque, alpha-tested, blended.
void add_forward(pipeline::FrameGraph& graph, const FrameParts& parts, const std::string& prefix,
                 const ForwardTarget& target);

/// What goes over lit color: separate draws, then draws of blended materials, depth tested and not written.
/// The passes are `prefix` + "blended" and the like.
void add_blended(pipeline::FrameGraph& graph, const FrameParts& parts, const std::string& prefix,
                 const ForwardTarget& target);

/// The same over a finished image of one sample a pixel, where the frame's depth has more: into a layer of as
/// many samples, whose mean goes over the image. Adds nothing where there is nothing to draw. `depth`: of
/// what is opaque. `blended`: also the draws of blended materials; else separate ones alone, for bases that
/// draw blended materials as coverage.
void add_over_output(pipeline::FrameGraph& graph, const FrameParts& parts, pipeline::ImageId output,
                     pipeline::ImageId depth, const pipeline::MulticastPattern& layers, bool blended);

/// Depth-stencil image and color image in the frame's size times `scale`.
ForwardTarget make_forward_target(pipeline::FrameGraph& graph, const std::string& name, int width, int height,
                                  int samples, Format color = Format::rgba8_srgb,
                                  Format depth = Format::d24_unorm_s8,
                                  const pipeline::MulticastPattern& layers = {});

/// Whether sample counts beyond the GPU's are made by viewport multicast.
enum class Emulate : std::uint8_t { automatic, on, off };
inline constexpr std::string_view kEmulateChoices = "auto|on|off";
/// The layers of eight samples that make `samples`; none where they are native, or to be.
pipeline::MulticastPattern multicast_layers(const FrameRequest& request, int samples, Emulate emulate);

/// A compute pass with an invocation for each pixel of the frame.
pipeline::Pass& add_frame_compute(pipeline::FrameGraph& graph, const std::string& name,
                                  const pipeline::ComputeProgram& program, pipeline::Uniforms uniforms);

/// A pass of `program` over the whole of `target`.
pipeline::Pass& add_full_screen(pipeline::FrameGraph& graph, const std::string& name,
                                std::vector<pipeline::ImageId> sampled, pipeline::ImageId target,
                                const pipeline::FragmentProgram& program, pipeline::Uniforms uniforms);

/// The final image: rgba8_srgb, 1x.
pipeline::ImageId add_output(pipeline::FrameGraph& graph);

/// Camera matrix with sub-pixel jitter (docs/techniques/forward.md#supersampling).
glm::mat4 jittered(const glm::mat4& clip_from_world, glm::vec2 jitter_px, int width, int height);

pipeline::PipelineState opaque_state(const ForwardTarget& target);
/// Color over color by the alpha that is drawn.
pipeline::BlendState blend_over();

}  // namespace hwsim::algos
