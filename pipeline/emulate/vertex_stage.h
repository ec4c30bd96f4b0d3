#pragma once
// Vertex fetch, shading and the post-transform cache of a segment's draws.
#include "pipeline/emulate/pass_context.h"

namespace hwsim::pipeline {

/// Misses of a FIFO post-transform cache for each run of kItemPrimitives primitives.
std::vector<std::uint32_t> count_cache_misses(std::span<const std::uint32_t> indices, std::size_t vertices,
                                              std::uint32_t indices_per_primitive, int cache_entries);

/// Marks items that lie outside the view volume; returns their number.
std::uint64_t mark_outside(const PassContext& context, Segment& segment);

/// Charges the chunks for fetching and shading, as the cache lets vertices through.
void count_vertex_work(const PassContext& context, const Segment& segment, int cache_entries,
                       BinWorker& worker);

/// Shades the vertices of the segment's items that are not outside, once.
void shade_vertices(const PassContext& context, Segment& segment, int jobs);

}  // namespace hwsim::pipeline
