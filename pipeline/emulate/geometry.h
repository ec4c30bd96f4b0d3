#pragma once
// The geometry stages of a draw pass: vertex shading, clipping, culling, set-up, binning.
#include "pipeline/emulate/pass_context.h"
#include "pipeline/emulate/vertex_stage.h"

namespace hwsim::pipeline {

inline constexpr std::size_t kSegmentTriangles =
    262144;  ///< bounds memory: about 80 bytes a triangle that is drawn

struct GeometryOptions {
  int jobs = 1;
  bool skip_frustum = true;
};

/// Cuts draws [first, last) into items. A segment's memory is used again by the next one.
void start_segment(const PassContext& context, std::uint32_t first, std::uint32_t last, Segment& segment);
/// After a pass's last one: gives back what other passes would not need.
void end_segments(Segment& segment, std::vector<BinWorker>& workers);

/// Shades the segment's vertices; `workers` hold the counters. Returns the number of draws that were skipped
/// because they lie outside the view volume (their triangles are counted as culled all the same).
std::uint64_t run_vertices(const PassContext& context, Segment& segment, const GeometryOptions& options,
                           std::vector<BinWorker>& workers, VertexFetches& fetches);

/// Chooses the items to build next and drops those built before; false when none is left. All of a segment's
/// at once, but where geometry shaders run as many as memory bounds: what they emit is not known before.
bool next_items(const PassContext& context, Segment& segment);

/// Geometry shaders, set-up and binning of the segment's chosen items.
void run_primitives(const PassContext& context, Segment& segment, int jobs, std::vector<BinWorker>& workers);

}  // namespace hwsim::pipeline
