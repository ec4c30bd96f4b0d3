#pragma once
// A run of draws whose triangles are set up, binned and rasterized together. Segments bound memory; they
// follow each other in submission order, so the image does not depend on where they are cut; lanes issued do
// by a little, for a batch of quads ends with its segment.
#include <cstdint>
#include <vector>

#include "hwsim/trace/counters.h"
#include "pipeline/base/zeroed_vector.h"
#include "pipeline/batch/fragment_batch.h"
#include "pipeline/graph/frame_graph.h"
#include "pipeline/raster/triangle_setup.h"

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

/// Set high in a vertex number: the vertex was made by clipping or by a geometry shader, and is the item's
/// own.
inline constexpr std::uint32_t kOwnVertexBit = 0x80000000u;

/// A triangle on its way to its bins; it is set up where it is rasterized.
struct BinTriangle {
  ScreenVertex screen[3];
  std::uint32_t vertex[3];  ///< among the draw's, or the item's own
  std::uint32_t primitive;  ///< number in the pass, in submission order
  TrianglePlace place;
  std::int16_t layer;  ///< layer of the attachments
};

/// What a worker builds of an item, before it is sorted by bin.
struct BuiltPrimitives {
  std::vector<BinTriangle> triangles;
  std::vector<RasterPoint> points;  ///< what a draw of points has in place of triangles
};

/// Up to kItemPrimitives primitives of one draw.
inline constexpr std::uint32_t kItemPrimitives = kClusterTriangles;
struct GeometryItem {
  std::uint32_t draw = 0;
  std::uint32_t first_primitive = 0, primitive_count = 0;  ///< within the draw
  bool outside = false;                                    ///< no part of it is in the view volume

  BuiltPrimitives* built = nullptr;  ///< set while it is built
  std::size_t built_triangles = 0;   ///< how many that were; a point is two
  std::vector<float> own_varyings;   ///< varyings of the vertices that are its own

  // Copies by bin, in submission order within a bin: of the bins of a rectangle, layer by layer.
  int bin_left = 0, bin_top = 0, bins_x = 0, bins_y = 0;
  const std::uint32_t* bin_start = nullptr;  ///< for each bin and one more, offsets into one of these
  const BinTriangle* triangles = nullptr;
  const RasterPoint* points = nullptr;
};

/// The primitives of an item in one bin.
struct BinRun {
  std::uint32_t item, first, last;  ///< a number among the segment's, and a range of what it holds
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
  ZeroedVector<ShadedVertex> vertices;        ///< room for these, or for those of a larger segment before
  ZeroedVector<float> varyings;  ///< all draws'; stride: varying_scalars of the draw's vertex program
  std::uint32_t first_draw = 0;
  std::vector<std::uint32_t> vertex_base;  ///< by draw of the segment: its first element of `vertices`
  std::vector<std::size_t> varying_base;   ///< likewise of `varyings`

  std::vector<std::vector<BinRun>> runs;  ///< by layer and bin: what the items built now have there
  std::vector<std::uint32_t> bins;        ///< those that have any

  const float* varyings_of(const GeometryItem& item, std::uint32_t vertex, std::uint32_t stride) const {
    if ((vertex & kOwnVertexBit) != 0) return item.own_varyings.data() + (vertex & ~kOwnVertexBit) * stride;
    return varyings.data() + varying_base[item.draw - first_draw] + std::size_t{vertex} * stride;
  }
};

}  // namespace hwsim::pipeline
