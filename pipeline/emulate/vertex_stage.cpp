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

// Every corner of the box outside one plane, with a margin for rounding: then so is every triangle in it.
bool outside_view(const glm::mat4& clip, const glm::vec3& a, const glm::vec3& b, const GuardBand& band) {
  int common = 63;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec4 p = clip * glm::vec4((corner & 1) != 0 ? b.x : a.x, (corner & 2) != 0 ? b.y : a.y,
                                         (corner & 4) != 0 ? b.z : a.z, 1.0f);
    const float margin = 1e-4f * (std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z) + std::fabs(p.w));
    const float grown[4] = {p.x, p.y, p.z, p.w};
    int code = 0;
    for (int axis = 0; axis < 2; ++axis) {
      const float limit = grown[3] * (axis == 0 ? band.view_x : band.view_y);
      if (grown[axis] < -limit - margin) code |= 1 << (2 * axis);
      if (grown[axis] > limit + margin) code |= 2 << (2 * axis);
    }
    if (grown[2] < -margin) code |= 16;
    if (grown[2] > grown[3] + margin) code |= 32;
    common &= code;
  }
  return common != 0;
}

/// The clusters of a draw of a whole part; a list's triangles lie in any order.
std::span<const TriangleCluster> clusters_of(const DrawInfo& draw) {
  const bool whole_part = draw.part != nullptr && draw.batch->state.raster.topology == Topology::triangles &&
                          draw.indices == draw.mesh->indices.data() + draw.part->first_index &&
                          draw.index_count == draw.part->index_count;
  if (!whole_part) return {};
  return draw.part->clusters;
}

/// Marks the items of one draw that lie outside the view volume; returns how many they are.
std::uint64_t mark_outside(const DrawInfo& draw, const GuardBand& band, std::span<GeometryItem> items) {
  const VertexProgram& program = *draw.batch->vertex;
  // A geometry program may place what it emits anywhere.
  if (program.clip_from_world == nullptr || draw.batch->geometry != nullptr) return 0;
  const glm::mat4 clip =
      *program.clip_from_world(draw.batch->vertex_uniforms.get()) * glm::make_mat4(draw.world_from_local);
  const bool whole = outside_view(clip, draw.mesh->bounds_min, draw.mesh->bounds_max, band);
  const std::span<const TriangleCluster> clusters = clusters_of(draw);
  std::uint64_t count = 0;
  for (GeometryItem& item : items) {
    const std::size_t cluster = item.first_primitive / kItemPrimitives;
    item.outside = whole || (!clusters.empty() && outside_view(clip, clusters[cluster].bounds_min,
                                                               clusters[cluster].bounds_max, band));
    count += item.outside ? 1 : 0;
  }
  return count;
}

void fetch_vertices(const DrawInfo& draw, std::uint32_t first, int count, VertexBatch& batch) {
  const Mesh& mesh = *draw.mesh;
  batch.count = count;
  batch.world_from_local = draw.world_from_local;
  batch.normal_from_local = draw.normal_from_local;
  const bool tangents = !mesh.tangents.empty(), uvs = !mesh.uv0.empty(), colors = !mesh.colors.empty();
  const bool uvs1 = !mesh.uv1.empty();
  const TextureView* alpha = draw.material != nullptr ? draw.material->base_color_texture : nullptr;
  batch.alpha_uv_set = alpha != nullptr ? alpha->uv_set : 0;
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
    batch.uv1[0][i] = uvs1 ? mesh.uv1[v].x : 0.0f;
    batch.uv1[1][i] = uvs1 ? mesh.uv1[v].y : 0.0f;
    batch.radius[i] = mesh.radius.empty() ? 0.0f : mesh.radius[v];
  }
}

void shade_range(const PassContext& context, const DrawInfo& draw, std::uint32_t first, std::uint32_t count,
                 ShadedVertex* out, float* varyings, VertexBatch& batch) {
  const VertexProgram& program = *draw.batch->vertex;
  for (std::uint32_t done = 0; done < count; done += kBatchLanes) {
    const int n = static_cast<int>(std::min<std::uint32_t>(kBatchLanes, count - done));
    fetch_vertices(draw, draw.first_vertex + first + done, n, batch);
    program.run(batch, draw.batch->vertex_uniforms.get());
    for (int i = 0; i < n; ++i) {
      const float clip[4] = {batch.clip_position[0][i], batch.clip_position[1][i], batch.clip_position[2][i],
                             batch.clip_position[3][i]};
      out[done + static_cast<std::uint32_t>(i)] =
          place_vertex(clip, context.band, context.width, context.height);
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
  n.mem.index_read_bytes += indices * static_cast<std::uint64_t>(draw.index_bytes);
  n.mem.vertex_read_bytes += static_cast<std::uint64_t>(draw.mesh->vertex_bytes) * misses;
}

struct VertexTask {
  std::uint32_t draw, first, count;
};

/// Marks the tasks of a draw whose vertices an item in view may use.
void mark_needed(const DrawInfo& draw, const GeometryItem& item, std::vector<char>& needed) {
  if (item.outside) return;
  std::uint32_t first = 0, last = static_cast<std::uint32_t>(needed.size()) - 1;
  if (const std::span<const TriangleCluster> clusters = clusters_of(draw); !clusters.empty()) {
    const TriangleCluster& cluster = clusters[item.first_primitive / kItemPrimitives];
    first = (cluster.first_vertex - draw.first_vertex) / kVertexTask;
    last = (cluster.last_vertex - draw.first_vertex) / kVertexTask;
  }
  std::fill(needed.begin() + first, needed.begin() + last + 1, 1);
}

std::vector<VertexTask> vertex_tasks(const PassContext& context, const Segment& segment) {
  std::vector<VertexTask> tasks;
  std::vector<char> needed;
  for (auto item = segment.items.begin(); item != segment.items.end();) {
    const std::uint32_t number = item->draw;
    const DrawInfo& draw = context.draws[number];
    needed.assign((draw.vertex_count + kVertexTask - 1) / kVertexTask, 0);
    for (; item != segment.items.end() && item->draw == number; ++item) mark_needed(draw, *item, needed);
    for (std::uint32_t i = 0; i < needed.size(); ++i)
      if (needed[i] != 0)
        tasks.push_back(
            {number, i * kVertexTask, std::min(kVertexTask, draw.vertex_count - i * kVertexTask)});
  }
  return tasks;
}

/// body(place of the index, vertex) for each miss of a FIFO post-transform cache.
template <class Body>
void for_each_cache_miss(std::span<const std::uint32_t> indices, std::size_t vertices, int cache_entries,
                         Body&& body) {
  std::vector<std::uint64_t> loaded(vertices, 0);  // 1 + the miss by which the vertex came in last
  std::uint64_t total = 0;
  for (std::uint32_t i = 0; i < indices.size(); ++i) {
    const std::uint32_t vertex = indices[i];
    std::uint64_t& at = loaded[vertex];
    if (at != 0 && total - at < static_cast<std::uint64_t>(cache_entries)) continue;
    at = ++total;
    body(i, vertex);
  }
}

/// A read of a sampled line by a primitive of the part.
struct LineRead {
  std::uint32_t primitive, line, bytes;
};

struct PartFetch {
  std::vector<std::uint32_t> misses;  ///< one number a run of kItemPrimitives primitives
  std::vector<LineRead> reads;        ///< by primitive
};

/// Vertices come whole, over one line or more; indices in order.
PartFetch fetch_part(const DrawInfo& draw, std::uint32_t first_line, int cache_entries, int shift) {
  const std::uint32_t per_primitive = draw.indices_per_primitive();
  const auto vertex_bytes = static_cast<std::uint32_t>(draw.mesh->vertex_bytes);
  PartFetch fetch;
  fetch.misses.assign((draw.index_count / per_primitive + kItemPrimitives - 1) / kItemPrimitives + 1, 0);
  for_each_cache_miss(
      {draw.indices, draw.index_count}, draw.mesh->positions.size(), cache_entries,
      [&](std::uint32_t i, std::uint32_t vertex) {
        fetch.misses[i / (per_primitive * kItemPrimitives)] += 1;
        const std::uint64_t start = std::uint64_t{vertex} * vertex_bytes, end = start + vertex_bytes;
        for (std::uint64_t line = start / kLineBytes; line * kLineBytes < end; ++line) {
          const std::uint32_t number = first_line + static_cast<std::uint32_t>(line);
          if (!is_sampled(number, shift)) continue;
          const std::uint64_t from = std::max(start, line * kLineBytes),
                              to = std::min(end, (line + 1) * kLineBytes);
          fetch.reads.push_back({i / per_primitive, number, static_cast<std::uint32_t>(to - from)});
        }
      });
  const auto index_bytes = static_cast<std::uint32_t>(draw.index_bytes);
  const std::uint32_t in_line = kLineBytes / index_bytes;
  for (std::uint32_t i = 0; i < draw.index_count; i += in_line) {
    const std::uint32_t number = ~first_line - (draw.first_index + i) / in_line;
    if (is_sampled(number, shift)) fetch.reads.push_back({i / per_primitive, number, kLineBytes});
  }
  std::stable_sort(fetch.reads.begin(), fetch.reads.end(),
                   [](const LineRead& a, const LineRead& b) { return a.primitive < b.primitive; });
  return fetch;
}

void track_reads(const DrawInfo& draw, const GeometryItem& item, const PartFetch& fetch,
                 AccessTracker& tracker) {
  const auto before = [](const LineRead& read, std::uint32_t primitive) {
    return read.primitive < primitive;
  };
  auto read = std::lower_bound(fetch.reads.begin(), fetch.reads.end(), item.first_primitive, before);
  tracker.start_bin(0);
  for (; read != fetch.reads.end() && read->primitive < item.first_primitive + item.primitive_count; ++read) {
    tracker.start_primitive(draw.first_primitive + read->primitive);
    tracker.touch(ReuseStream::geometry, read->line, read->bytes, 0);
  }
}

}  // namespace

std::vector<std::uint32_t> count_cache_misses(std::span<const std::uint32_t> indices, std::size_t vertices,
                                              std::uint32_t indices_per_primitive, int cache_entries) {
  const std::size_t primitives = indices.size() / indices_per_primitive;
  std::vector<std::uint32_t> misses((primitives + kItemPrimitives - 1) / kItemPrimitives + 1, 0);
  for_each_cache_miss(indices, vertices, cache_entries, [&](std::uint32_t i, std::uint32_t) {
    misses[i / (indices_per_primitive * kItemPrimitives)] += 1;
  });
  return misses;
}

std::uint64_t mark_outside(const PassContext& context, Segment& segment) {
  std::uint64_t count = 0;
  for (std::size_t first = 0, last = 0; first < segment.items.size(); first = last) {
    const std::uint32_t draw = segment.items[first].draw;
    while (last < segment.items.size() && segment.items[last].draw == draw) ++last;
    count += mark_outside(context.draws[draw], context.band,
                          std::span(segment.items).subspan(first, last - first));
  }
  return count;
}

void count_vertex_work(const PassContext& context, const Segment& segment, int cache_entries,
                       BinWorker& worker) {
  const int shift = worker.tracker.kinds[index_of(ReuseStream::geometry)].shift;
  std::map<const std::uint32_t*, PartFetch> fetches;  // instances share their mesh's indices
  for (const GeometryItem& item : segment.items) {
    const DrawInfo& draw = context.draws[item.draw];
    auto found = fetches.find(draw.indices);
    if (found == fetches.end()) {
      // Meshes begin at places that a hash scatters: no list of their sizes is needed.
      const std::uint32_t first_line = block_hash(2 * draw.mesh_number + 1) >> 1;
      found = fetches.emplace(draw.indices, fetch_part(draw, first_line, cache_entries, shift)).first;
    }
    const std::uint32_t chunk = (draw.first_primitive + item.first_primitive) / context.chunk_primitives;
    count_vertices(context, item, found->second.misses[item.first_primitive / kItemPrimitives],
                   worker.chunks[chunk]);
    track_reads(draw, item, found->second, worker.tracker);
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
