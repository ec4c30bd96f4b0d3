#include "algos/base/prepass.h"

#include "algos/base/shaders/prepass.h"
#include "pipeline/shade/mesh_vertex.h"

namespace hwsim::algos {
namespace {
using namespace pipeline;

DrawBatch depth_batch(const FrameParts& parts, const ForwardTarget& target,
                      const std::vector<DrawCall>& draws, const VertexProgram& vertex) {
  DrawBatch batch = mesh_batch(parts, draws, vertex);
  batch.state = opaque_state(target);
  batch.state.depth = {true, true, Compare::less};
  batch.vertex_uniforms = std::make_shared<MeshVertexUniforms>(
      MeshVertexUniforms{jittered(parts.clip_from_world, target.jitter_px, target.width, target.height)});
  return batch;
}

/// Vertex colors have an alpha too, which the shadow map's program does not know.
DrawBatch masked_batch(const FrameParts& parts, const ForwardTarget& target) {
  const VertexProgram& vertex = parts.full_varyings ? mesh_full_program() : mesh_uv_program();
  DrawBatch batch = depth_batch(parts, target, parts.draws.mask, vertex);
  batch.fragment = parts.full_varyings ? &full_alpha_test_program() : &alpha_test_program();
  batch.fragment_uniforms = std::make_shared<AlphaTestUniforms>();
  return batch;
}

}  // namespace

void describe_prepass(OptionList& list, bool& prepass) {
  list.choice("prepass", prepass, "off|on",
              "a pass of depth alone before it, so that only what is visible is shaded");
}

void add_prepass(FrameGraph& graph, const FrameParts& parts, const std::string& prefix,
                 const ForwardTarget& target) {
  Pass& pass = add_target_pass(graph, parts, prefix + "prepass", target);
  pass.color.clear();
  pass.sampled.clear();
  pass.batches.push_back(depth_batch(parts, target, parts.draws.opaque, mesh_position_program()));
  if (parts.separate_taken)
    add_opaque_separate(pass, parts, SurfaceInputs::none,
                        depth_batch(parts, target, {}, mesh_position_program()));
  if (!parts.draws.mask.empty()) pass.batches.push_back(masked_batch(parts, target));
}

void draw_where_equal(PipelineState& state) { state.depth = {true, false, Compare::equal}; }

}  // namespace hwsim::algos
