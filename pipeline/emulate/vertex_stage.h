#pragma once
// Vertex fetch, shading and the post-transform cache of a segment's draws.
#include <map>
#include <tuple>
#include <vector>

#include "pipeline/emulate/pass_context.h"

namespace hwsim::pipeline {

/// Misses of a FIFO post-transform cache for each run of kItemPrimitives primitives.
std::vector<std::uint32_t> count_cache_misses(std::span<const std::uint32_t> indices, std::size_t vertices,
                                              std::uint32_t indices_per_primitive, int cache_entries);

/// Marks items that lie outside the view volume; returns their number.
std::uint64_t mark_outside(const PassContext& context, Segment& segment);

/// A read of a sampled line by a primitive of a list.
struct LineRead {
  std::uint32_t primitive, line, bytes;
};

/// What fetching the vertices of a list of indices costs.
struct VertexFetch {
  std::vector<std::uint32_t> misses;  ///< one number a run of kItemPrimitives primitives
  std::vector<LineRead> reads;        ///< by primitive
};

/// The fetches of a frame: instances and passes share the lists of their meshes.
class VertexFetches {
 public:
  VertexFetches(int cache_entries, bool exact) : cache_entries_(cache_entries), exact_(exact) {}
  /// The draw's list; `is_new`: nothing is known of it yet.
  VertexFetch& of(const DrawInfo& draw, bool& is_new);
  const VertexFetch& of(const DrawInfo& draw) const { return by_list_.at(key(draw)); }
  void find(const DrawInfo& draw, VertexFetch& fetch) const;

 private:
  using Key = std::tuple<const std::uint32_t*, std::uint32_t, std::uint32_t>;
  static Key key(const DrawInfo& draw) {
    return {draw.indices, draw.index_count, draw.indices_per_primitive()};
  }
  const int cache_entries_;
  const bool exact_;
  std::map<Key, VertexFetch> by_list_;
};

/// Shades the vertices of the segment's items that are not outside, once, and finds the fetches of their
/// lists.
void shade_vertices(const PassContext& context, Segment& segment, int jobs, VertexFetches& fetches);

/// Charges the chunks for fetching and shading, as the cache lets vertices through.
void count_vertex_work(const PassContext& context, const Segment& segment, const VertexFetches& fetches,
                       BinWorker& worker);

}  // namespace hwsim::pipeline
