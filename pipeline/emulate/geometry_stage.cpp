#include "pipeline/emulate/geometry_stage.h"

#include <algorithm>

#include "pipeline/batch/accounting.h"

namespace hwsim::pipeline {
namespace {

constexpr std::uint64_t kScalarBytes = 4;

void load_batch(const VertexSource& source, std::span<const std::uint32_t> indices, GeometryBatch& batch) {
  for (std::size_t lane = 0; lane < static_cast<std::size_t>(batch.count); ++lane) {
    for (std::size_t v = 0; v < 3; ++v) {
      const std::uint32_t vertex = indices[3 * lane + v];
      for (std::size_t k = 0; k < 4; ++k)
        batch.clip_position[v][k][lane] = source.vertices[vertex].clip_position[k];
      batch.varyings[v][lane] = source.varyings + vertex * source.stride;
    }
  }
}

/// Sets up what one lane emitted; its vertices get places of their own among the item's.
class LaneOutput {
 public:
  LaneOutput(const PassContext& context, GeometryItem& item, const DrawBatch& draws)
      : band_(guard_band(context.width, context.height)),
        context_(context),
        item_(item),
        program_(*draws.geometry),
        tessellated_(draws.tessellated_points),
        scalars_(static_cast<std::size_t>(program_.varying_scalars)) {}

  void add(const GeometryBatch& batch, std::size_t lane, std::uint32_t primitive, PassCounters& n) {
    const auto count = static_cast<std::size_t>(batch.vertex_count[lane]);
    if (count == 0) return;
    vertices_.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const float* vertex = batch.vertex(lane, i);
      const float clip[4] = {vertex[0], vertex[1], vertex[2], vertex[3]};
      vertices_.push_back(place_vertex(clip, band_, context_.width, context_.height));
    }
    PrimitiveSetup setup(
        context_, {vertices_.data(), batch.vertex(lane, 0) + 4, batch.scalars_per_vertex(), scalars_, true},
        item_);
    setup.start_primitive(primitive, n);
    const std::uint64_t primitives = program_.output == GeometryOutput::points
                                         ? add_points(setup, count)
                                         : add_strips(setup, batch, lane, count);
    n.stats.geometry_shader_primitives += primitives;
    n.gs.output_vertices += count;
    if (!tessellated_) n.gs.output_bytes += count * batch.scalars_per_vertex() * kScalarBytes;
  }

 private:
  static std::uint64_t add_points(PrimitiveSetup& setup, std::size_t count) {
    for (std::uint32_t i = 0; i < count; ++i) setup.add_point(i);
    return count;
  }
  /// Every second triangle of a strip turns the other way.
  static std::uint64_t add_strips(PrimitiveSetup& setup, const GeometryBatch& batch, std::size_t lane,
                                  std::size_t count) {
    std::uint64_t primitives = 0;
    std::uint32_t in_strip = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      in_strip = batch.starts_strip[batch.first_vertex(lane) + i] != 0 ? 1 : in_strip + 1;
      if (in_strip < 3) continue;
      const bool odd = in_strip % 2 == 0;
      setup.add_triangle(odd ? i - 1 : i - 2, odd ? i - 2 : i - 1, i);
      ++primitives;
    }
    return primitives;
  }

  GuardBand band_;
  const PassContext& context_;
  GeometryItem& item_;
  const GeometryProgram& program_;
  bool tessellated_;
  std::size_t scalars_;
  std::vector<ShadedVertex> vertices_;
};

}  // namespace

void run_geometry_shader_stage(const PassContext& context, const VertexSource& source,
                               std::span<const std::uint32_t> indices, GeometryItem& item,
                               GeometryBatch& batch, std::vector<PassCounters>& chunks) {
  const DrawInfo& draw = context.draws[item.draw];
  const GeometryProgram& program = *draw.batch->geometry;
  batch.width_px = context.width;
  batch.height_px = context.height;
  batch.mirrored = draw.mirrored;
  batch.material = draw.material;
  LaneOutput output(context, item, *draw.batch);
  std::uint32_t next = 0;
  while (next < item.primitive_count) {
    const std::uint32_t primitive = draw.first_primitive + item.first_primitive + next;
    const std::uint32_t in_chunk = context.chunk_primitives - primitive % context.chunk_primitives;
    const std::uint32_t count = std::min({in_chunk, item.primitive_count - next, std::uint32_t{kBatchLanes}});
    PassCounters& n = chunks[primitive / context.chunk_primitives];
    batch.start(program);
    batch.count = static_cast<int>(count);
    batch.counters = &n;
    load_batch(source, indices.subspan(std::size_t{3} * next, std::size_t{3} * count), batch);
    for (std::uint32_t lane = 0; lane < count; ++lane)
      batch.primitive[lane] = static_cast<std::int32_t>(item.first_primitive + next + lane);
    program.run(batch, draw.batch->geometry_uniforms.get());
    n.stats.input_assembly_primitives += count;
    n.stats.geometry_shader_invocations += count;
    n.gs.input_bytes += count * 3 * (4 + static_cast<std::uint64_t>(program.input_scalars)) * kScalarBytes;
    const std::uint64_t valid = count == kBatchLanes ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
    account_blocks(batch.blocks, program.ops, program.block_count, valid, n);
    for (std::uint32_t lane = 0; lane < count; ++lane) output.add(batch, lane, primitive + lane, n);
    next += count;
  }
}

}  // namespace hwsim::pipeline
