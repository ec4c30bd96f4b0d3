#include "pipeline/emulate/vertex_stage.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <map>

#include "pipeline/base/parallel.h"
#include "pipeline/emulate/primitive_setup.h"

namespace hwsim::pipeline {
namespace {

constexpr std::uint32_t kVertexTask = 1024;  // vertices of one parallel task

// Every corner of the mesh's box outside one plane, with a margin for rounding: then so is every triangle.
bool outside_view(const DrawInfo& draw) {
  const VertexProgram& program = *draw.batch->vertex;
  if (program.clip_from_world == nullptr) return false;
  const glm::mat4 clip =
      *program.clip_from_world(draw.batch->vertex_uniforms.get()) * glm::make_mat4(draw.world_from_local);
  int common = 63;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3& a = draw.mesh->bounds_min;
    const glm::vec3& b = draw.mesh->bounds_max;
    const glm::vec4 p = clip * glm::vec4((corner & 1) != 0 ? b.x : a.x, (corner & 2) != 0 ? b.y : a.y,
                                         (corner & 4) != 0 ? b.z : a.z, 1.0f);
    const float margin = 1e-4f * (std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z) + std::fabs(p.w));
    const float grown[4] = {p.x, p.y, p.z, p.w};
    int code = 0;
    for (int axis = 0; axis < 2; ++axis) {
      if (grown[axis] < -grown[3] - margin) code |= 1 << (2 * axis);
      if (grown[axis] > grown[3] + margin) code |= 2 << (2 * axis);
    }
    if (grown[2] < -margin) code |= 16;
    if (grown[2] > grown[3] + margin) code |= 32;
    common &= code;
  }
  return common != 0;
}

void fetch_vertices(const DrawInfo& draw, std::uint32_t first, int count, VertexBatch& batch) {
  const Mesh& mesh = *draw.mesh;
  batch.count = count;
  batch.world_from_local = draw.world_from_local;
  batch.normal_from_local = draw.normal_from_local;
  const bool tangents = !mesh.tangents.empty(), uvs = !mesh.uv0.empty(), colors = !mesh.colors.empty();
  for (int i = 0; i < count; ++i) {
    const std::size_t v = first + static_cast<std::uint32_t>(i);
    for (int k = 0; k < 3; ++k) {
      batch.position[k][i] = mesh.positions[v][k];
      batch.normal[k][i] = mesh.normals[v][k];
    }
    for (int k = 0; k < 4; ++k) {
      batch.tangent[k][i] = tangents ? mesh.tangents[v][k] : (k == 0 || k == 3 ? 1.0f : 0.0f);
      batch.color[k][i] = colors ? mesh.colors[v][k] : 1.0f;
    }
    batch.uv0[0][i] = uvs ? mesh.uv0[v].x : 0.0f;
    batch.uv0[1][i] = uvs ? mesh.uv0[v].y : 0.0f;
    batch.radius[i] = mesh.radius.empty() ? 0.0f : mesh.radius[v];
  }
}

void shade_range(const PassContext& context, const DrawInfo& draw, std::uint32_t first, std::uint32_t count,
                 ShadedVertex* out, float* varyings, VertexBatch& batch) {
  const VertexProgram& program = *draw.batch->vertex;
  const GuardBand band = guard_band(context.width, context.height);
  for (std::uint32_t done = 0; done < count; done += kBatchLanes) {
    const int n = static_cast<int>(std::min<std::uint32_t>(kBatchLanes, count - done));
    fetch_vertices(draw, draw.first_vertex + first + done, n, batch);
    program.run(batch, draw.batch->vertex_uniforms.get());
    for (int i = 0; i < n; ++i) {
      const float clip[4] = {batch.clip_position[0][i], batch.clip_position[1][i], batch.clip_position[2][i],
                             batch.clip_position[3][i]};
      out[done + static_cast<std::uint32_t>(i)] = place_vertex(clip, band, context.width, context.height);
      float* to = varyings + (std::size_t{done} + static_cast<std::size_t>(i)) *
                                 static_cast<std::size_t>(program.varying_scalars);
      for (int k = 0; k < program.varying_scalars; ++k) to[k] = batch.varyings[k][i];
    }
  }
}

void count_vertices(const PassContext& context, const GeometryItem& item, std::uint32_t misses,
                    PassCounters& n) {
  const DrawInfo& draw = context.draws[item.draw];
  const VertexProgram& program = *draw.batch->vertex;
  const std::uint64_t indices = std::uint64_t{draw.indices_per_primitive()} * item.primitive_count;
  n.stats.input_assembly_vertices += indices;
  n.stats.vertex_shader_invocations += misses;
  n.vs.alu_lane_ops += std::uint64_t{program.ops.alu} * misses;
  n.vs.sfu_lane_ops += std::uint64_t{program.ops.sfu} * misses;
  n.vs.output_scalars += static_cast<std::uint64_t>(program.varying_scalars + 4) * misses;
  n.mem.index_read_bytes += indices * static_cast<std::uint64_t>(std::max(2, draw.mesh->index_bytes));
  n.mem.vertex_read_bytes += static_cast<std::uint64_t>(draw.mesh->vertex_bytes) * misses;
}

struct VertexTask {
  std::uint32_t draw, first, count;
};

std::vector<VertexTask> vertex_tasks(const PassContext& context, const Segment& segment) {
  std::vector<VertexTask> tasks;
  for (std::size_t i = 0; i < segment.vertex_base.size(); ++i) {
    if (segment.outside[i] != 0) continue;
    const auto draw = segment.first_draw + static_cast<std::uint32_t>(i);
    const std::uint32_t count = context.draws[draw].vertex_count;
    for (std::uint32_t first = 0; first < count; first += kVertexTask)
      tasks.push_back({draw, first, std::min(kVertexTask, count - first)});
  }
  return tasks;
}

}  // namespace

std::vector<std::uint32_t> count_cache_misses(const Mesh& mesh, const Mesh::Part& part,
                                              std::uint32_t indices_per_primitive, int cache_entries) {
  const std::uint32_t primitives = part.index_count / indices_per_primitive;
  std::vector<std::uint32_t> misses((primitives + kItemPrimitives - 1) / kItemPrimitives + 1, 0);
  std::vector<std::uint64_t> loaded(mesh.positions.size(),
                                    0);  // 1 + the miss by which the vertex came in last
  std::uint64_t total = 0;
  for (std::uint32_t i = 0; i < part.index_count; ++i) {
    std::uint64_t& at = loaded[mesh.indices[part.first_index + i]];
    if (at != 0 && total - at < static_cast<std::uint64_t>(cache_entries)) continue;
    at = ++total;
    misses[i / (indices_per_primitive * kItemPrimitives)] += 1;
  }
  return misses;
}

std::uint64_t mark_outside(const PassContext& context, Segment& segment) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < segment.outside.size(); ++i) {
    segment.outside[i] = outside_view(context.draws[segment.first_draw + i]) ? 1 : 0;
    count += segment.outside[i] != 0 ? 1 : 0;
  }
  return count;
}

void count_vertex_work(const PassContext& context, const Segment& segment, int cache_entries,
                       std::vector<PassCounters>& chunks) {
  std::map<const Mesh::Part*, std::vector<std::uint32_t>> misses;  // instances share their mesh's parts
  for (const GeometryItem& item : segment.items) {
    const DrawInfo& draw = context.draws[item.draw];
    auto found = misses.find(draw.part);
    if (found == misses.end())
      found = misses
                  .emplace(draw.part, count_cache_misses(*draw.mesh, *draw.part, draw.indices_per_primitive(),
                                                         cache_entries))
                  .first;
    const std::uint32_t chunk = (draw.first_primitive + item.first_primitive) / context.chunk_primitives;
    count_vertices(context, item, found->second[item.first_primitive / kItemPrimitives], chunks[chunk]);
  }
}

void shade_vertices(const PassContext& context, Segment& segment, int jobs) {
  const std::vector<VertexTask> tasks = vertex_tasks(context, segment);
  std::vector<VertexBatch> batches(static_cast<std::size_t>(std::max(1, jobs)));
  parallel_for(tasks.size(), jobs, [&](std::size_t i, int worker) {
    const VertexTask& task = tasks[i];
    const DrawInfo& draw = context.draws[task.draw];
    const std::size_t local = task.draw - segment.first_draw;
    float* varyings = segment.varyings.data() + segment.varying_base[local] +
                      std::size_t{task.first} * static_cast<std::size_t>(draw.batch->vertex->varying_scalars);
    shade_range(context, draw, task.first, task.count,
                segment.vertices.data() + segment.vertex_base[local] + task.first, varyings,
                batches[static_cast<std::size_t>(worker)]);
  });
}

}  // namespace hwsim::pipeline
