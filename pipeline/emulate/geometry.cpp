#include "pipeline/emulate/geometry.h"

#include <algorithm>

#include "pipeline/base/parallel.h"
#include "pipeline/emulate/binning.h"
#include "pipeline/emulate/geometry_stage.h"
#include "pipeline/emulate/primitive_setup.h"
#include "pipeline/emulate/vertex_stage.h"

namespace hwsim::pipeline {
namespace {

VertexSource source_of(const Segment& segment, const DrawInfo& draw, std::uint32_t draw_number) {
  const std::size_t local = draw_number - segment.first_draw;
  return {segment.vertices.data() + segment.vertex_base[local],
          segment.varyings.data() + segment.varying_base[local],
          static_cast<std::size_t>(draw.batch->vertex->varying_scalars),
          static_cast<std::size_t>(draw.batch->vertex->varying_scalars)};
}

void shade_primitives(const PassContext& context, const Segment& segment, GeometryItem& item,
                      BinWorker& worker) {
  const DrawInfo& draw = context.draws[item.draw];
  std::vector<std::uint32_t> indices(
      draw.indices + std::size_t{3} * item.first_primitive,
      draw.indices + std::size_t{3} * (item.first_primitive + item.primitive_count));
  for (std::uint32_t& index : indices) index -= draw.first_vertex;
  if (!worker.geometry_batch) worker.geometry_batch = std::make_unique<GeometryBatch>();
  run_geometry_shader_stage(context, source_of(segment, draw, item.draw), indices, item,
                            *worker.geometry_batch, worker.chunks);
}

/// Assembles an item's primitives and sets them up.
void assemble(const PassContext& context, const Segment& segment, GeometryItem& item,
              std::vector<PassCounters>& chunks) {
  const DrawInfo& draw = context.draws[item.draw];
  PrimitiveSetup setup(context, source_of(segment, draw, item.draw), item);
  const std::uint32_t step = draw.indices_per_primitive();
  const std::uint32_t* indices = draw.indices + step * item.first_primitive;
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
}

// An item outside the view volume: every triangle goes the way that `add` would send it.
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
  return segment;
}

std::uint64_t run_vertices(const PassContext& context, Segment& segment, const GeometryOptions& options,
                           std::vector<BinWorker>& workers) {
  const std::uint64_t skipped = options.skip_frustum ? mark_outside(context, segment) : 0;
  count_vertex_work(context, segment, options.cache_entries, workers[0]);
  shade_vertices(context, segment, options.jobs);
  return skipped;
}

void run_primitives(const PassContext& context, Segment& segment, int jobs, std::vector<BinWorker>& workers) {
  parallel_for(segment.last_item - segment.first_item, jobs, [&](std::size_t i, int worker_number) {
    GeometryItem& item = segment.items[segment.first_item + i];
    BinWorker& worker = workers[static_cast<std::size_t>(worker_number)];
    if (item.outside) {
      count_outside(context, item, worker.chunks);
      item.bin_start.assign(
          static_cast<std::size_t>(context.bins_x * context.bins_y) * context.viewports.size() + 1, 0);
      return;
    }
    if (context.draws[item.draw].batch->geometry != nullptr)
      shade_primitives(context, segment, item, worker);
    else
      assemble(context, segment, item, worker.chunks);
    if (item.points.empty())
      bin_triangles(context, item);
    else
      bin_points(context, item);
  });
}

bool next_items(const PassContext& context, Segment& segment) {
  if (segment.last_item == segment.items.size()) return false;
  const auto shades = [&](const GeometryItem& item) {
    return context.draws[item.draw].batch->geometry != nullptr;
  };
  const std::size_t built = segment.last_item - segment.first_item;
  std::size_t triangles = 0;
  for (std::size_t i = segment.first_item; i < segment.last_item; ++i) {
    triangles += segment.items[i].triangles.size() + 2 * segment.items[i].points.size();
    GeometryItem spent;  // gives its memory back
    std::swap(spent, segment.items[i]);
  }
  segment.first_item = segment.last_item;
  if (std::none_of(segment.items.begin() + static_cast<std::ptrdiff_t>(segment.first_item),
                   segment.items.end(), shades)) {
    segment.last_item = segment.items.size();
    return true;
  }
  // As many as would fill a segment if they emit as much as the last ones did; a few to begin with.
  constexpr std::size_t kFirstItems = 8;
  const std::size_t next =
      built == 0 ? kFirstItems
                 : std::clamp<std::size_t>(built * kSegmentTriangles / (triangles + 1), 1, 4 * built);
  segment.last_item = std::min(segment.items.size(), segment.first_item + next);
  return true;
}

}  // namespace hwsim::pipeline
