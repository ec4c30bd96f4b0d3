#include "pipeline/emulate/geometry.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>
#include <map>

#include "pipeline/base/parallel.h"
#include "pipeline/raster/clip.h"

namespace hwsim::pipeline {
namespace {

constexpr std::uint32_t kVertexTask = 1024;  // vertices of one parallel task

ScreenVertex to_screen(const double* p, int width_px, int height_px) {
  const double inv_w = 1.0 / p[3];
  const double x = (p[0] * inv_w * 0.5 + 0.5) * width_px, y = (0.5 - p[1] * inv_w * 0.5) * height_px;
  ScreenVertex v;
  v.x = static_cast<std::int32_t>(std::floor(x * kSubpixelUnits + 0.5));
  v.y = static_cast<std::int32_t>(std::floor(y * kSubpixelUnits + 0.5));
  v.z = static_cast<float>(p[2] * inv_w);
  v.inv_w = static_cast<float>(inv_w);
  return v;
}

bool in_guard_band(const double* p, const GuardBand& band) {
  return p[3] > 0 && p[2] >= 0 && p[2] <= p[3] && p[0] >= band.min_x * p[3] && p[0] <= band.max_x * p[3] &&
         p[1] >= band.min_y * p[3] && p[1] <= band.max_y * p[3];
}

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

void shade_vertices(const PassContext& context, const DrawInfo& draw, std::uint32_t first,
                    std::uint32_t count, ShadedVertex* out, float* varyings, VertexBatch& batch) {
  const VertexProgram& program = *draw.batch->vertex;
  const GuardBand band = guard_band(context.width, context.height);
  for (std::uint32_t done = 0; done < count; done += kBatchLanes) {
    const int n = static_cast<int>(std::min<std::uint32_t>(kBatchLanes, count - done));
    fetch_vertices(draw, draw.first_vertex + first + done, n, batch);
    program.run(batch, draw.batch->vertex_uniforms.get());
    for (int i = 0; i < n; ++i) {
      ShadedVertex& v = out[done + static_cast<std::uint32_t>(i)];
      double p[4];
      for (int k = 0; k < 4; ++k) {
        v.clip_position[k] = batch.clip_position[k][i];
        p[k] = v.clip_position[k];
      }
      v.outcode = static_cast<std::uint8_t>(frustum_outcode(v.clip_position));
      v.needs_clip = !in_guard_band(p, band);
      if (!v.needs_clip) v.screen = to_screen(p, context.width, context.height);
      float* to = varyings + (std::size_t{done} + static_cast<std::size_t>(i)) *
                                 static_cast<std::size_t>(program.varying_scalars);
      for (int k = 0; k < program.varying_scalars; ++k) to[k] = batch.varyings[k][i];
    }
  }
}

/// Assembles, clips, culls and sets up the triangles of one item.
class ItemBuilder {
 public:
  ItemBuilder(const PassContext& context, const Segment& segment, GeometryItem& item,
              std::vector<PassCounters>& chunks)
      : c_(context),
        draw_(context.draws[item.draw]),
        item_(item),
        chunks_(chunks),
        band_(guard_band(context.width, context.height)) {
    const std::size_t local = item.draw - segment.first_draw;
    vertices_ = segment.vertices.data() + segment.vertex_base[local];
    varyings_ = segment.varyings.data() + segment.varying_base[local];
    stride_ = static_cast<std::size_t>(draw_.batch->vertex->varying_scalars);
    const bool triangles = draw_.batch->state.raster.topology == Topology::triangles;
    rules_ = {draw_.cull_back && triangles,
              draw_.cull_front && triangles,
              context.width,
              context.height,
              context.sample_min_x,
              context.sample_min_y,
              context.sample_max_x,
              context.sample_max_y,
              draw_.batch->state.raster.conservative};
  }

  void run() {
    item_.triangles.clear();
    item_.clipped_varyings.clear();
    const std::uint32_t step = draw_.indices_per_primitive();
    const std::uint32_t* indices =
        draw_.mesh->indices.data() + draw_.part->first_index + step * item_.first_primitive;
    for (std::uint32_t i = 0; i < item_.primitive_count; ++i, indices += step) {
      primitive_ = draw_.first_primitive + item_.first_primitive + i;
      chunk_ = primitive_ / c_.chunk_primitives;
      const auto vertex = [&](int k) { return indices[k] - draw_.first_vertex; };
      switch (draw_.batch->state.raster.topology) {
        case Topology::triangles:
          add({vertex(0), vertex(1), vertex(2)});
          break;
        case Topology::points:
          add_point(vertex(0));
          break;
        case Topology::line_strip:
          add_line(vertex(0), vertex(1));
          break;
      }
    }
    bin();
  }

 private:
  using Vertices = std::array<std::uint32_t, 3>;

  /// A quadrilateral in screen space, two triangles; corners in order around it, attributes of the vertices
  /// given.
  void add_quad(const std::array<ScreenVertex, 4>& corner, const std::array<std::uint32_t, 4>& v,
                PassCounters& n) {
    n.stats.clipping_primitives += 1;
    for (const std::size_t i : {std::size_t{1}, std::size_t{2}}) {
      const ScreenVertex screen[3] = {corner[0], corner[i], corner[i + 1]};
      set_up(screen, {v[0], v[i], v[i + 1]}, n);
    }
  }

  void add_point(std::uint32_t v) {
    PassCounters& n = chunks_[chunk_];
    n.stats.input_assembly_primitives += 1;
    n.stats.clipping_invocations += 1;
    const ShadedVertex& vertex = vertices_[v];
    if (vertex.outcode != 0) return cull_outside(n);  // by its center, as Direct3D does
    const auto half = static_cast<std::int32_t>(
        std::lround(draw_.batch->state.raster.primitive_size_px * 0.5f * kSubpixelUnits));
    std::array<ScreenVertex, 4> corner;
    corner.fill(vertex.screen);
    for (std::size_t i = 0; i < 4; ++i) {
      corner[i].x += i == 1 || i == 2 ? half : -half;
      corner[i].y += i >= 2 ? half : -half;
    }
    add_quad(corner, {v, v, v, v}, n);
  }

  void add_line(std::uint32_t a, std::uint32_t b) {
    PassCounters& n = chunks_[chunk_];
    n.stats.input_assembly_primitives += 1;
    n.stats.clipping_invocations += 1;
    if ((vertices_[a].outcode & vertices_[b].outcode) != 0) return cull_outside(n);
    std::array<ClipVertex, kMaxClippedVertices> ends;
    const int count = clip_triangle({clip_vertex(a, 0), clip_vertex(b, 1), clip_vertex(b, 1)}, band_, ends);
    if (count < 3) return cull_outside(n);
    // A triangle without width comes back as its clipped segment: the ends are the extremes of vertex 0's
    // weight.
    const auto [to, from] = std::minmax_element(
        ends.begin(), ends.begin() + count,
        [](const ClipVertex& p, const ClipVertex& q) { return p.weights[0] < q.weights[0]; });
    if (from->position[3] <= 1e-30 || to->position[3] <= 1e-30) return cull_outside(n);
    const auto first = clipped_count();
    append_varyings({a, b, b}, from->weights);
    append_varyings({a, b, b}, to->weights);
    const ScreenVertex p = to_screen(from->position.data(), c_.width, c_.height);
    const ScreenVertex q = to_screen(to->position.data(), c_.width, c_.height);
    const double dx = q.x - p.x, dy = q.y - p.y, length = std::sqrt(dx * dx + dy * dy);
    const double half =
        length > 0 ? draw_.batch->state.raster.primitive_size_px * 0.5 * kSubpixelUnits / length : 0.0;
    const auto nx = static_cast<std::int32_t>(std::lround(-dy * half)),
               ny = static_cast<std::int32_t>(std::lround(dx * half));
    const auto moved = [](ScreenVertex v, std::int32_t x, std::int32_t y) {
      v.x += x;
      v.y += y;
      return v;
    };
    const std::uint32_t i = first | kClippedVertexBit, j = (first + 1) | kClippedVertexBit;
    add_quad({moved(p, nx, ny), moved(q, nx, ny), moved(q, -nx, -ny), moved(p, -nx, -ny)}, {i, j, j, i}, n);
  }

  ClipVertex clip_vertex(std::uint32_t v, std::size_t corner) const {
    ClipVertex out;
    for (std::size_t k = 0; k < 4; ++k) out.position[k] = vertices_[v].clip_position[k];
    out.weights[corner] = 1.0;
    return out;
  }

  static void cull_outside(PassCounters& n) {
    n.setup.in_primitives += 1;
    n.setup.culled_frustum_primitives += 1;
  }

  std::uint32_t clipped_count() const {
    return static_cast<std::uint32_t>(stride_ == 0 ? 0 : item_.clipped_varyings.size() / stride_);
  }

  void add(const Vertices& v) {
    PassCounters& n = chunks_[chunk_];
    const ShadedVertex &a = vertices_[v[0]], &b = vertices_[v[1]], &c = vertices_[v[2]];
    n.stats.input_assembly_primitives += 1;
    n.stats.clipping_invocations += 1;
    if ((a.outcode & b.outcode & c.outcode) != 0) return cull_outside(n);
    if (a.needs_clip || b.needs_clip || c.needs_clip) {
      add_clipped(v, n);
      return;
    }
    n.stats.clipping_primitives += 1;
    const ScreenVertex screen[3] = {a.screen, b.screen, c.screen};
    set_up(screen, v, n);
  }

  void add_clipped(const Vertices& v, PassCounters& n) {
    std::array<ClipVertex, kMaxClippedVertices> polygon;
    const int count =
        clip_triangle({clip_vertex(v[0], 0), clip_vertex(v[1], 1), clip_vertex(v[2], 2)}, band_, polygon);
    bool usable = count >= 3;
    for (int i = 0; i < count; ++i)
      usable = usable && polygon[static_cast<std::size_t>(i)].position[3] > 1e-30;
    if (!usable) return cull_outside(n);
    const std::uint32_t first = clipped_count();
    for (int i = 0; i < count; ++i) append_varyings(v, polygon[static_cast<std::size_t>(i)].weights);
    for (int i = 1; i + 1 < count; ++i) {
      const int fan[3] = {0, i, i + 1};
      ScreenVertex screen[3];
      Vertices index;
      for (std::size_t k = 0; k < 3; ++k) {
        screen[k] = to_screen(polygon[static_cast<std::size_t>(fan[k])].position.data(), c_.width, c_.height);
        index[k] = (first + static_cast<std::uint32_t>(fan[k])) | kClippedVertexBit;
      }
      n.stats.clipping_primitives += 1;
      set_up(screen, index, n);
    }
  }

  void append_varyings(const Vertices& v, const std::array<double, 3>& weights) {
    for (std::size_t k = 0; k < stride_; ++k) {
      double value = 0.0;
      for (std::size_t i = 0; i < 3; ++i) value += weights[i] * varyings_[v[i] * stride_ + k];
      item_.clipped_varyings.push_back(static_cast<float>(value));
    }
  }

  void set_up(const ScreenVertex (&screen)[3], const Vertices& v, PassCounters& n) {
    n.setup.in_primitives += 1;
    RasterTriangle t;
    switch (set_up_triangle(screen, rules_, t)) {
      case SetupResult::backface:
        n.setup.culled_backface_primitives += 1;
        return;
      case SetupResult::zero_area:
        n.setup.culled_zero_area_primitives += 1;
        return;
      case SetupResult::sample_miss:
        n.setup.culled_sample_miss_primitives += 1;
        return;
      case SetupResult::drawn:
        break;
    }
    n.setup.out_primitives += 1;
    for (std::size_t i = 0; i < 3; ++i) t.vertex[i] = v[i];
    t.draw = item_.draw;
    t.chunk = chunk_;
    t.primitive = primitive_;
    item_.triangles.push_back(t);
  }

  // Counting sort of (bin, triangle) pairs: bins in order, triangles in submission order within each.
  void bin() {
    const auto bins = static_cast<std::size_t>(c_.bins_x) * static_cast<std::size_t>(c_.bins_y);
    item_.bin_start.assign(bins + 1, 0);
    for (const RasterTriangle& t : item_.triangles)
      for_each_bin(t, [&](std::size_t b) { item_.bin_start[b + 1] += 1; });
    for (std::size_t b = 0; b < bins; ++b) item_.bin_start[b + 1] += item_.bin_start[b];
    item_.binned.resize(item_.bin_start[bins]);
    std::vector<std::uint32_t> next(item_.bin_start.begin(), item_.bin_start.end() - 1);
    for (std::uint32_t i = 0; i < item_.triangles.size(); ++i)
      for_each_bin(item_.triangles[i], [&](std::size_t b) { item_.binned[next[b]++] = i; });
  }

  template <class Body>
  void for_each_bin(const RasterTriangle& t, Body&& body) const {
    const int left = t.min_x / kBinPx, right = t.max_x / kBinPx, top = t.min_y / kBinPx,
              bottom = t.max_y / kBinPx;
    for (int y = top; y <= bottom; ++y)
      for (int x = left; x <= right; ++x)
        if ((left == right && top == bottom) || touches_bin(t, x, y))
          body(static_cast<std::size_t>(y) * static_cast<std::size_t>(c_.bins_x) +
               static_cast<std::size_t>(x));
  }

  // Some point of the bin inside each edge; a bin's samples lie within its square.
  static bool touches_bin(const RasterTriangle& t, int bin_x, int bin_y) {
    constexpr std::int64_t kSize = 16 * kBinPx;
    for (int i = 0; i < 3; ++i) {
      const std::int64_t a = t.a[i], b = t.b[i];
      const std::int64_t x = bin_x * kSize + (a > 0 ? kSize : 0), y = bin_y * kSize + (b > 0 ? kSize : 0);
      if (a * x + b * y + t.c[i] < 0) return false;
    }
    return true;
  }

  const PassContext& c_;
  const DrawInfo& draw_;
  GeometryItem& item_;
  std::vector<PassCounters>& chunks_;
  GuardBand band_;
  const ShadedVertex* vertices_;
  const float* varyings_;
  std::size_t stride_;
  SetupRules rules_;
  std::uint32_t primitive_ = 0, chunk_ = 0;
};

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

namespace {

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

}  // namespace

std::uint64_t run_geometry(const PassContext& context, Segment& segment, const GeometryOptions& options,
                           std::vector<BinWorker>& workers) {
  const std::uint64_t skipped = options.skip_frustum ? mark_outside(context, segment) : 0;
  count_vertex_work(context, segment, options.cache_entries, workers[0].chunks);
  const std::vector<VertexTask> tasks = vertex_tasks(context, segment);
  std::vector<VertexBatch> batches(workers.size());
  parallel_for(tasks.size(), options.jobs, [&](std::size_t i, int worker) {
    const VertexTask& task = tasks[i];
    const DrawInfo& draw = context.draws[task.draw];
    const std::size_t local = task.draw - segment.first_draw;
    float* varyings = segment.varyings.data() + segment.varying_base[local] +
                      std::size_t{task.first} * static_cast<std::size_t>(draw.batch->vertex->varying_scalars);
    shade_vertices(context, draw, task.first, task.count,
                   segment.vertices.data() + segment.vertex_base[local] + task.first, varyings,
                   batches[static_cast<std::size_t>(worker)]);
  });
  parallel_for(segment.items.size(), options.jobs, [&](std::size_t i, int worker) {
    GeometryItem& item = segment.items[i];
    std::vector<PassCounters>& chunks = workers[static_cast<std::size_t>(worker)].chunks;
    if (segment.outside[item.draw - segment.first_draw] != 0) {
      count_outside(context, item, chunks);
      item.bin_start.assign(static_cast<std::size_t>(context.bins_x * context.bins_y) + 1, 0);
      return;
    }
    ItemBuilder(context, segment, item, chunks).run();
  });
  return skipped;
}

}  // namespace hwsim::pipeline
