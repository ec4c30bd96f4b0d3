#pragma once
// What the variants of selective supersampling share: the multisampled frame, the triangles that may be
// sampled, and the composite.
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "algos/base/frame_parts.h"
#include "algos/sss/options.h"
#include "algos/sss/shaders/programs.h"
#include "pipeline/shade/mesh_vertex.h"

namespace hwsim::algos {

/// The critical triangles of a draw, and which of its attributes samples need.
struct CriticalDraw {
  pipeline::DrawCall call;
  SssVertex vertex = SssVertex::plain;
};

struct SssFrame {
  FrameParts parts;
  ForwardTarget base;
  std::vector<CriticalDraw> critical;
  pipeline::ImageId below;   ///< the frame, resolved: what the composite lies over
  pipeline::ImageId marks;   ///< samples of the frame whose triangle is sampled; none: nothing asks
  bool over_others = false;  ///< beside samples the composite takes the frame's without a mark for the rest
  SssUniforms uniforms;
};

/// What a variant asks of the passes that all share.
struct SssNeeds {
  bool marks = false;  ///< whatever lies under the samples
  /// Points that a triangle can have; none: no points.
  std::function<int(SssVertex)> most_points = nullptr;
};

/// The area beyond which triangles are left to the frame.
float largest_sampled_px2(const SssOptions& options, const SssNeeds& needs, SssVertex vertex);

/// The multisampled frame. With critical triangles, what the further passes start from; without, the output.
SssFrame start_sss_frame(pipeline::FrameGraph& graph, const FrameRequest& request, const SssOptions& options,
                         const SssNeeds& needs);

/// What passes that sample read: the frame's depth, and the shadow map.
std::vector<pipeline::ImageId> sss_slots(const SssFrame& frame);

void add_sss_composite(pipeline::FrameGraph& graph, const SssFrame& frame,
                       const pipeline::FragmentProgram& program, std::vector<pipeline::ImageId> sums,
                       std::vector<pipeline::BufferId> buffers);

/// One batch for each kind of vertex that the critical triangles have.
template <class Fill>
void add_sss_batches(pipeline::Pass& pass, const SssFrame& f, Fill&& fill) {
  for (const SssVertex vertex : {SssVertex::plain, SssVertex::textured, SssVertex::full}) {
    pipeline::DrawBatch batch;
    for (const CriticalDraw& draw : f.critical)
      if (draw.vertex == vertex) batch.draws.push_back(draw.call);
    if (batch.draws.empty()) continue;
    batch.vertex =
        vertex == SssVertex::full ? &pipeline::mesh_full_program() : &pipeline::mesh_surface_program();
    batch.vertex_uniforms =
        std::make_shared<pipeline::MeshVertexUniforms>(pipeline::MeshVertexUniforms{f.parts.clip_from_world});
    batch.state.raster.cull = pipeline::CullMode::none;  // the geometry shader has done it
    fill(batch, vertex);
    pass.batches.push_back(std::move(batch));
  }
}

}  // namespace hwsim::algos
