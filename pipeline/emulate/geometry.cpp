#include "pipeline/emulate/geometry.h"

#include <algorithm>
#include <cstdint>

#include "pipeline/base/huge_pages.h"
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

/// Assembles an item's primitives and culls them, a chunk at a time.
void assemble(const PassContext& context, const Segment& segment, GeometryItem& item,
              std::vector<PassCounters>& chunks) {
  const DrawInfo& draw = context.draws[item.draw];
  PrimitiveSetup setup(context, source_of(segment, draw, item.draw), item);
  const Topology topology = draw.batch->state.raster.topology;
  const std::uint32_t step = draw.indices_per_primitive();
  for (std::uint32_t i = 0, next = 0; i < item.primitive_count; i = next) {
    const std::uint32_t primitive = draw.first_primitive + item.first_primitive + i;
    const std::uint32_t in_chunk = context.chunk_primitives - primitive % context.chunk_primitives;
    next = std::min(item.primitive_count, i + in_chunk);
    const std::uint32_t* indices = draw.indices + std::size_t{step} * (item.first_primitive + i);
    PassCounters& n = chunks[primitive / context.chunk_primitives];
    n.stats.input_assembly_primitives += next - i;
    setup.start_primitive(primitive, n);
    if (topology == Topology::triangles) {
      setup.add_triangles(indices, next - i, draw.first_vertex);
      continue;
    }
    for (std::uint32_t k = 0; k < next - i; ++k, ++indices) {
      setup.start_primitive(primitive + k, n);
      if (topology == Topology::points)
        setup.add_point(indices[0] - draw.first_vertex);
      else
        setup.add_line(indices[0] - draw.first_vertex, indices[1] - draw.first_vertex);
    }
  }
}

// An item outside the view volume: every triangle goes the way that `add_triangle` would send it.
void count_outside(const PassContext& context, const GeometryItem& item, std::vector<PassCounters>& chunks) {
  const std::uint32_t first = context.draws[item.draw].first_primitive + item.first_primitive;
  for (std::uint32_t i = 0, next = 0; i < item.primitive_count; i = next) {
    const std::uint32_t in_chunk = context.chunk_primitives - (first + i) % context.chunk_primitives;
    next = std::min(item.primitive_count, i + in_chunk);
    PassCounters& n = chunks[(first + i) / context.chunk_primitives];
    n.stats.input_assembly_primitives += next - i;
    n.stats.clipping_invocations += next - i;
    n.setup.in_primitives += next - i;
    n.setup.culled_frustum_primitives += next - i;
  }
}

constexpr std::size_t kKeptBytes = std::size_t{16} << 20;  // memory of each kind that stays from pass to pass

template <class T>
void make_room(ZeroedVector<T>& elements, std::size_t count) {
  if (elements.size() >= count) return;
  ZeroedVector<T>(count).swap(elements);
  prefer_huge_pages(elements.data(), count);
}

}  // namespace

void start_segment(const PassContext& context, std::uint32_t first, std::uint32_t last, Segment& segment) {
  segment.first_draw = first;
  segment.items.clear();
  segment.first_item = segment.last_item = 0;
  segment.vertex_base.clear();
  segment.varying_base.clear();
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
  make_room(segment.vertices, vertices);
  make_room(segment.varyings, scalars);
}

void end_segments(Segment& segment, std::vector<BinWorker>& workers) {
  segment.items.clear();
  if (segment.vertices.size() * sizeof(ShadedVertex) > kKeptBytes)
    ZeroedVector<ShadedVertex>().swap(segment.vertices);
  if (segment.varyings.size() * sizeof(float) > kKeptBytes) ZeroedVector<float>().swap(segment.varyings);
  for (BinWorker& worker : workers) worker.arena.clear(kKeptBytes);
}

std::uint64_t run_vertices(const PassContext& context, Segment& segment, const GeometryOptions& options,
                           std::vector<BinWorker>& workers, VertexFetches& fetches) {
  const std::uint64_t skipped = options.skip_frustum ? mark_outside(context, segment) : 0;
  shade_vertices(context, segment, options.jobs, fetches);
  count_vertex_work(context, segment, fetches, workers[0]);
  return skipped;
}

void run_primitives(const PassContext& context, Segment& segment, int jobs, std::vector<BinWorker>& workers) {
  for (BinWorker& worker : workers) worker.arena.clear(SIZE_MAX);
  parallel_for(segment.last_item - segment.first_item, jobs, [&](std::size_t i, int worker_number) {
    GeometryItem& item = segment.items[segment.first_item + i];
    BinWorker& worker = workers[static_cast<std::size_t>(worker_number)];
    if (item.outside) return count_outside(context, item, worker.chunks);
    item.built = &worker.built;
    if (context.draws[item.draw].batch->geometry != nullptr)
      shade_primitives(context, segment, item, worker);
    else
      assemble(context, segment, item, worker.chunks);
    sort_into_bins(context, item, worker.arena);
  });
  list_bins(context, segment);
}

bool next_items(const PassContext& context, Segment& segment) {
  if (segment.last_item == segment.items.size()) return false;
  const auto shades = [&](const GeometryItem& item) {
    return context.draws[item.draw].batch->geometry != nullptr;
  };
  const std::size_t built = segment.last_item - segment.first_item;
  std::size_t triangles = 0;
  for (std::size_t i = segment.first_item; i < segment.last_item; ++i) {
    triangles += segment.items[i].built_triangles;
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
