#include "pipeline/emulate/vertex_stage.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "pipeline/base/parallel.h"
#include "pipeline/emulate/pass_reuse.h"
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

/// A FIFO post-transform cache in front of vertices [first, first + count).
class VertexCache {
 public:
  VertexCache(std::uint32_t first, std::size_t count, int entries)
      : first_(first),
        entries_(static_cast<std::uint32_t>(entries)),
        loaded_(count, 0u - entries_) {}  // so long ago that they are gone

  /// Writes the places of the indices that miss to `places`, as long as the indices; returns their number.
  /// Without branches: whether an index misses is hard to foretell.
  std::size_t find_misses(std::span<const std::uint32_t> indices, std::uint32_t* places) {
    constexpr std::size_t kAhead = 32;
    std::size_t found = 0;
    std::uint32_t total = total_;
    for (std::uint32_t i = 0; i < indices.size(); ++i) {
      if (i + kAhead < indices.size()) __builtin_prefetch(&loaded_[indices[i + kAhead] - first_]);
      std::uint32_t& loaded = loaded_[indices[i] - first_];
      // The sign of a difference of 64 bits.
      const auto miss =
          static_cast<std::uint32_t>((std::uint64_t{entries_} - 1 - std::uint64_t{total - loaded}) >> 63);
      total += miss;
      loaded ^= (loaded ^ total) & (0u - miss);
      places[found] = i;
      found += miss;
    }
    total_ = total;
    return found;
  }

 private:
  const std::uint32_t first_, entries_;
  std::uint32_t total_ = 0;            // misses so far
  std::vector<std::uint32_t> loaded_;  // by which miss the vertex came in last
};

/// Sampled lines of vertices that come whole, over one line or more.
class VertexLines {
 public:
  VertexLines(const DrawInfo& draw, std::uint32_t first_line, int shift)
      : vertex_bytes_(static_cast<std::uint32_t>(draw.mesh->vertex_bytes)),
        first_line_(first_line),
        shift_(shift) {}

  void read(std::uint32_t primitive, std::uint32_t vertex, std::vector<LineRead>& reads) const {
    const std::uint64_t start = std::uint64_t{vertex} * vertex_bytes_, end = start + vertex_bytes_;
    for (std::uint64_t line = start / kLineBytes; line * kLineBytes < end; ++line) {
      const std::uint32_t number = first_line_ + static_cast<std::uint32_t>(line);
      if (!is_sampled(number, shift_)) continue;
      const std::uint64_t from = std::max(start, line * kLineBytes),
                          to = std::min(end, (line + 1) * kLineBytes);
      reads.push_back({primitive, number, static_cast<std::uint32_t>(to - from)});
    }
  }

 private:
  const std::uint32_t vertex_bytes_, first_line_;
  const int shift_;
};

/// Lines of indices, which come in order.
void read_indices(const DrawInfo& draw, std::uint32_t first_line, int shift, std::vector<LineRead>& reads) {
  const std::uint32_t in_line = kLineBytes / static_cast<std::uint32_t>(draw.index_bytes);
  for (std::uint32_t i = 0; i < draw.index_count; i += in_line) {
    const std::uint32_t number = ~first_line - (draw.first_index + i) / in_line;
    if (is_sampled(number, shift)) reads.push_back({i / draw.indices_per_primitive(), number, kLineBytes});
  }
}

void track_reads(const DrawInfo& draw, const GeometryItem& item, const VertexFetch& fetch,
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

/// body(first place of a run of kItemPrimitives primitives, places within it that miss) for each run.
template <class Body>
void for_each_run(std::span<const std::uint32_t> indices, std::uint32_t indices_per_primitive,
                  VertexCache cache, Body&& body) {
  const std::size_t run = std::size_t{indices_per_primitive} * kItemPrimitives;
  std::vector<std::uint32_t> places(std::min(run, indices.size()));
  for (std::size_t first = 0; first < indices.size(); first += run) {
    const std::size_t count = std::min(run, indices.size() - first);
    const std::size_t found = cache.find_misses(indices.subspan(first, count), places.data());
    body(first, std::span<const std::uint32_t>(places).first(found));
  }
}

std::size_t run_count(std::size_t indices, std::uint32_t indices_per_primitive) {
  return (indices / indices_per_primitive + kItemPrimitives - 1) / kItemPrimitives + 1;
}

}  // namespace

VertexFetch& VertexFetches::of(const DrawInfo& draw, bool& is_new) {
  const auto [at, added] = by_list_.try_emplace(key(draw));
  is_new = added;
  return at->second;
}

void VertexFetches::find(const DrawInfo& draw, VertexFetch& fetch) const {
  const int shift = exact_ ? 0 : kReuseShiftMax;
  // Meshes begin at places that a hash scatters: no list of their sizes is needed.
  const std::uint32_t first_line = block_hash(2 * draw.mesh_number + 1) >> 1;
  const std::uint32_t per_primitive = draw.indices_per_primitive();
  const VertexLines lines(draw, first_line, shift);
  fetch.misses.assign(run_count(draw.index_count, per_primitive), 0);
  for_each_run({draw.indices, draw.index_count}, per_primitive,
               VertexCache(draw.first_vertex, draw.vertex_count, cache_entries_),
               [&](std::size_t first, std::span<const std::uint32_t> places) {
                 fetch.misses[first / (per_primitive * kItemPrimitives)] =
                     static_cast<std::uint32_t>(places.size());
                 for (const std::uint32_t place : places) {
                   const auto i = static_cast<std::uint32_t>(first) + place;
                   lines.read(i / per_primitive, draw.indices[i], fetch.reads);
                 }
               });
  const auto of_vertices = static_cast<std::ptrdiff_t>(fetch.reads.size());
  read_indices(draw, first_line, shift, fetch.reads);
  std::inplace_merge(fetch.reads.begin(), fetch.reads.begin() + of_vertices, fetch.reads.end(),
                     [](const LineRead& a, const LineRead& b) { return a.primitive < b.primitive; });
}

std::vector<std::uint32_t> count_cache_misses(std::span<const std::uint32_t> indices, std::size_t vertices,
                                              std::uint32_t indices_per_primitive, int cache_entries) {
  std::vector<std::uint32_t> misses(run_count(indices.size(), indices_per_primitive), 0);
  for_each_run(indices, indices_per_primitive, VertexCache(0, vertices, cache_entries),
               [&](std::size_t first, std::span<const std::uint32_t> places) {
                 misses[first / (indices_per_primitive * kItemPrimitives)] =
                     static_cast<std::uint32_t>(places.size());
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

void count_vertex_work(const PassContext& context, const Segment& segment, const VertexFetches& fetches,
                       BinWorker& worker) {
  const DrawInfo* last = nullptr;
  const VertexFetch* fetch = nullptr;
  for (const GeometryItem& item : segment.items) {
    const DrawInfo& draw = context.draws[item.draw];
    if (&draw != last) fetch = &fetches.of(draw);
    last = &draw;
    const std::uint32_t chunk = (draw.first_primitive + item.first_primitive) / context.chunk_primitives;
    count_vertices(context, item, fetch->misses[item.first_primitive / kItemPrimitives],
                   worker.chunks[chunk]);
    track_reads(draw, item, *fetch, worker.tracker);
  }
}

// Lists of indices first: they are the longest tasks.
void shade_vertices(const PassContext& context, Segment& segment, int jobs, VertexFetches& fetches) {
  std::vector<std::pair<const DrawInfo*, VertexFetch*>> lists;
  for (const GeometryItem& item : segment.items) {
    if (item.first_primitive != 0) continue;
    bool is_new = false;
    VertexFetch& fetch = fetches.of(context.draws[item.draw], is_new);
    if (is_new) lists.emplace_back(&context.draws[item.draw], &fetch);
  }
  const std::vector<VertexTask> tasks = vertex_tasks(context, segment);
  std::vector<VertexBatch> batches(static_cast<std::size_t>(std::max(1, jobs)));
  parallel_for(lists.size() + tasks.size(), jobs, [&](std::size_t i, int worker) {
    if (i < lists.size()) return fetches.find(*lists[i].first, *lists[i].second);
    const VertexTask& task = tasks[i - lists.size()];
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
