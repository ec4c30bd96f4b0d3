#include "pipeline/emulate/geometry.h"

#include <algorithm>

#include "pipeline/base/parallel.h"
#include "pipeline/emulate/binning.h"
#include "pipeline/emulate/primitive_setup.h"
#include "pipeline/emulate/vertex_stage.h"

namespace hwsim::pipeline {
namespace {

VertexSource source_of(const Segment& segment, const DrawInfo& draw, std::uint32_t draw_number) {
  const std::size_t local = draw_number - segment.first_draw;
  return {segment.vertices.data() + segment.vertex_base[local],
          segment.varyings.data() + segment.varying_base[local],
          static_cast<std::size_t>(draw.batch->vertex->varying_scalars)};
}

/// Assembles an item's primitives and sets them up.
void build_item(const PassContext& context, const Segment& segment, GeometryItem& item,
                std::vector<PassCounters>& chunks) {
  item.triangles.clear();
  item.clipped_varyings.clear();
  const DrawInfo& draw = context.draws[item.draw];
  PrimitiveSetup setup(context, source_of(segment, draw, item.draw), item);
  const std::uint32_t step = draw.indices_per_primitive();
  const std::uint32_t* indices =
      draw.mesh->indices.data() + draw.part->first_index + step * item.first_primitive;
  for (std::uint32_t i = 0; i < item.primitive_count; ++i, indices += step) {
    const std::uint32_t primitive = draw.first_primitive + item.first_primitive + i;
    PassCounters& n = chunks[primitive / context.chunk_primitives];
    n.stats.input_assembly_primitives += 1;
    setup.start_primitive(primitive, n);
    const auto vertex = [&](int k) { return indices[k] - draw.first_vertex; };
    switch (draw.batch->state.raster.topology) {
      case Topology::triangles:
        setup.add_triangle(vertex(0), vertex(1), vertex(2));
        break;
      case Topology::points:
        setup.add_point(vertex(0));
        break;
      case Topology::line_strip:
        setup.add_line(vertex(0), vertex(1));
        break;
    }
  }
  bin_triangles(context, item);
}

// A draw outside the view volume: every triangle goes the way that `add` would send it.
void count_outside(const PassContext& context, const GeometryItem& item, std::vector<PassCounters>& chunks) {
  for (std::uint32_t i = 0; i < item.primitive_count; ++i) {
    const std::uint32_t primitive = context.draws[item.draw].first_primitive + item.first_primitive + i;
    PassCounters& n = chunks[primitive / context.chunk_primitives];
    n.stats.input_assembly_primitives += 1;
    n.stats.clipping_invocations += 1;
    n.setup.in_primitives += 1;
    n.setup.culled_frustum_primitives += 1;
  }
}

}  // namespace

Segment make_segment(const PassContext& context, std::uint32_t first, std::uint32_t last) {
  Segment segment;
  segment.first_draw = first;
  std::uint32_t vertices = 0;
  std::size_t scalars = 0;
  for (std::uint32_t d = first; d < last; ++d) {
    const DrawInfo& draw = context.draws[d];
    segment.vertex_base.push_back(vertices);
    segment.varying_base.push_back(scalars);
    vertices += draw.vertex_count;
    scalars += std::size_t{draw.vertex_count} * static_cast<std::size_t>(draw.batch->vertex->varying_scalars);
    for (std::uint32_t t = 0; t < draw.primitive_count(); t += kItemPrimitives) {
      GeometryItem item;
      item.draw = d;
      item.first_primitive = t;
      item.primitive_count = std::min(kItemPrimitives, draw.primitive_count() - t);
      segment.items.push_back(std::move(item));
    }
  }
  segment.vertices.resize(vertices);
  segment.varyings.resize(scalars);
  segment.outside.assign(last - first, 0);
  return segment;
}

std::uint64_t run_geometry(const PassContext& context, Segment& segment, const GeometryOptions& options,
                           std::vector<BinWorker>& workers) {
  const std::uint64_t skipped = options.skip_frustum ? mark_outside(context, segment) : 0;
  count_vertex_work(context, segment, options.cache_entries, workers[0]);
  shade_vertices(context, segment, options.jobs);
  parallel_for(segment.items.size(), options.jobs, [&](std::size_t i, int worker) {
    GeometryItem& item = segment.items[i];
    std::vector<PassCounters>& chunks = workers[static_cast<std::size_t>(worker)].chunks;
    if (segment.outside[item.draw - segment.first_draw] != 0) {
      count_outside(context, item, chunks);
      item.bin_start.assign(
          static_cast<std::size_t>(context.bins_x * context.bins_y) * context.viewports.size() + 1, 0);
      return;
    }
    build_item(context, segment, item, chunks);
  });
  return skipped;
}

}  // namespace hwsim::pipeline
