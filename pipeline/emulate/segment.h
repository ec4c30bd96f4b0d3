#pragma once
// A run of draws whose triangles are set up, binned and rasterized together. Segments bound memory; they
// follow each other in submission order, so the image does not depend on where they are cut; lanes issued do
// by a little, for a batch of quads ends with its segment.
#include <cstdint>
#include <vector>

#include "hwsim/trace/counters.h"
#include "pipeline/batch/fragment_batch.h"
#include "pipeline/graph/frame_graph.h"

namespace hwsim::pipeline {

inline constexpr int kBinPx = 64;  ///< screen bins are the unit of parallel work
inline constexpr int kBlocksPerBin = kBinPx / kBlockPx;

/// One draw of a pass, ready to run.
struct DrawInfo {
  const DrawBatch* batch = nullptr;
  const Mesh* mesh = nullptr;
  std::uint32_t mesh_number = 0;  ///< in the scene
  const Mesh::Part* part = nullptr;
  const MaterialView* material = nullptr;
  float world_from_local[16] = {};
  float normal_from_local[9] = {};
  const std::uint32_t* indices = nullptr;  ///< the part's, or the call's own list
  std::uint32_t index_count = 0;
  std::uint32_t first_index = 0;  ///< place among the mesh's indices; a list's own place behind them
  int index_bytes = 4;            ///< as fetched
  bool mirrored = false;          ///< the transform flips the winding
  bool cull_back = false;         ///< after double-sidedness and mirroring
  bool cull_front = false;
  std::uint32_t first_vertex = 0, vertex_count = 0;  ///< range of the mesh's vertices that the part uses
  std::uint32_t first_primitive = 0;                 ///< number in the pass of its first primitive
  std::uint32_t indices_per_primitive() const {
    return batch->state.raster.topology == Topology::triangles ? 3 : 1;
  }
  std::uint32_t primitive_count() const {
    switch (batch->state.raster.topology) {
      case Topology::triangles:
        return index_count / 3;
      case Topology::points:
        return index_count;
      case Topology::line_strip:
        return index_count > 1 ? index_count - 1 : 0;
    }
    return 0;
  }
};

/// Set high in RasterTriangle::vertex: the vertex was made by clipping and lies in the item's own array.
inline constexpr std::uint32_t kClippedVertexBit = 0x80000000u;

/// Up to kItemPrimitives primitives of one draw.
inline constexpr std::uint32_t kItemPrimitives = kClusterTriangles;
struct GeometryItem {
  std::uint32_t draw = 0;
  std::uint32_t first_primitive = 0, primitive_count = 0;  ///< within the draw
  bool outside = false;                                    ///< no part of it is in the view volume

  std::vector<RasterTriangle> triangles;
  std::vector<RasterPoint> points;  ///< what a draw of points has in place of triangles
  std::vector<float> clipped_varyings;
  std::vector<std::uint32_t>
      binned;  ///< triangle or point numbers, sorted by bin, in submission order within a bin
  std::vector<std::uint32_t> bin_start;  ///< bins + 1 offsets into `binned`
};

/// A vertex after the vertex shader.
struct ShadedVertex {
  float clip_position[4];
  ScreenVertex screen;       ///< valid unless needs_clip
  std::uint8_t outcode = 0;  ///< see frustum_outcode
  bool needs_clip = false;   ///< behind near, beyond far, or out of the guard band
};

struct Segment {
  std::vector<GeometryItem> items;
  std::size_t first_item = 0, last_item = 0;  ///< those that are built now
  std::vector<ShadedVertex> vertices;
  std::vector<float> varyings;  ///< all draws'; stride: varying_scalars of the draw's vertex program
  std::uint32_t first_draw = 0;
  std::vector<std::uint32_t> vertex_base;  ///< by draw of the segment: its first element of `vertices`
  std::vector<std::size_t> varying_base;   ///< likewise of `varyings`
};

}  // namespace hwsim::pipeline
