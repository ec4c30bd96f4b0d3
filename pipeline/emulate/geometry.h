#pragma once
// The geometry stages of a draw pass: vertex shading, clipping, culling, set-up, binning.
#include "pipeline/emulate/pass_context.h"

namespace hwsim::pipeline {

struct GeometryOptions {
  int jobs = 1;
  int cache_entries = 32;
  bool skip_frustum = true;
};

/// Cuts draws [first, last) into items.
Segment make_segment(const PassContext& context, std::uint32_t first, std::uint32_t last);

/// Runs all geometry work of a segment; `chunks`: one array of counters for each worker. Returns the number
/// of draws that were skipped because they lie outside the view volume (their triangles are counted as culled
/// all the same).
std::uint64_t run_geometry(const PassContext& context, Segment& segment, const GeometryOptions& options,
                           std::vector<BinWorker>& workers);

}  // namespace hwsim::pipeline
