#include "pipeline/emulate/primitive_setup.h"

#include <cmath>

namespace hwsim::pipeline {
namespace {

bool in_guard_band(const double* p, const GuardBand& band) {
  return p[3] > 0 && p[2] >= 0 && p[2] <= p[3] && p[0] >= band.min_x * p[3] && p[0] <= band.max_x * p[3] &&
         p[1] >= band.min_y * p[3] && p[1] <= band.max_y * p[3];
}

void prefetch(const ShadedVertex& v) {
  __builtin_prefetch(&v.clip_position);
  __builtin_prefetch(&v.needs_clip);  // may lie in the line after
}

}  // namespace

SetupRules setup_rules(const PassContext& c, const DrawInfo& draw) {
  const GeometryProgram* geometry = draw.batch->geometry;
  const bool triangles = geometry != nullptr ? geometry->output == GeometryOutput::triangle_strip
                                             : draw.batch->state.raster.topology == Topology::triangles;
  return {draw.cull_back && triangles,
          draw.cull_front && triangles,
          c.width,
          c.height,
          c.sample_min_x,
          c.sample_min_y,
          c.sample_max_x,
          c.sample_max_y,
          draw.batch->state.raster.conservative};
}

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

ShadedVertex place_vertex(const float (&clip)[4], const GuardBand& band, int width_px, int height_px) {
  ShadedVertex v;
  double p[4];
  for (int k = 0; k < 4; ++k) p[k] = v.clip_position[k] = clip[k];
  v.outcode = static_cast<std::uint8_t>(frustum_outcode(clip, band));
  v.needs_clip = !in_guard_band(p, band);
  if (!v.needs_clip) v.screen = to_screen(p, width_px, height_px);
  return v;
}

PrimitiveSetup::PrimitiveSetup(const PassContext& context, const VertexSource& source, GeometryItem& item)
    : c_(context),
      draw_(context.draws[item.draw]),
      item_(item),
      source_(source),
      band_(context.band),
      rules_(setup_rules(context, draw_)) {}

void PrimitiveSetup::start_primitive(std::uint32_t primitive, PassCounters& counters) {
  primitive_ = primitive;
  counters_ = &counters;
}

void PrimitiveSetup::add_triangle(std::uint32_t v0, std::uint32_t v1, std::uint32_t v2) {
  PassCounters& n = *counters_;
  const ShadedVertex &a = source_.vertices[v0], &b = source_.vertices[v1], &c = source_.vertices[v2];
  n.stats.clipping_invocations += 1;
  if ((a.outcode & b.outcode & c.outcode) != 0) return cull_outside();
  if (a.needs_clip || b.needs_clip || c.needs_clip) return add_clipped({v0, v1, v2});
  n.stats.clipping_primitives += 1;
  const ScreenVertex screen[3] = {a.screen, b.screen, c.screen};
  place(screen, {kept_vertex(v0), kept_vertex(v1), kept_vertex(v2)});
}

void PrimitiveSetup::add_triangles(const std::uint32_t* indices, std::uint32_t count,
                                   std::uint32_t first_vertex) {
  if (c_.viewports.size() == 1) {
    const std::array<std::uint64_t, 4> results = place_triangles(indices, count, first_vertex);
    for (std::size_t r = 0; r < results.size(); ++r) {
      this->count(static_cast<SetupResult>(r), results[r]);
      counters_->stats.clipping_invocations += results[r];
      counters_->stats.clipping_primitives += results[r];
    }
    return;
  }
  for (std::uint32_t i = 0; i < count; ++i, ++primitive_, indices += 3)
    add_triangle(indices[0] - first_vertex, indices[1] - first_vertex, indices[2] - first_vertex);
}

/// The same for one viewport. Returns how many triangles met each result, but for those that needed clipping:
/// these are counted already.
std::array<std::uint64_t, 4> PrimitiveSetup::place_triangles(const std::uint32_t* indices,
                                                             std::uint32_t count,
                                                             std::uint32_t first_vertex) {
  constexpr std::uint32_t kAhead = 3 * 12;  // indices: their vertices lie anywhere
  std::array<std::uint64_t, 4> results{};
  std::vector<BinTriangle>& out = item_.built->triangles;
  const ShadedVertex* const vertices = source_.vertices;
  for (std::uint32_t i = 0; i < count; ++i, ++primitive_, indices += 3) {
    const std::uint32_t v0 = indices[0] - first_vertex, v1 = indices[1] - first_vertex,
                        v2 = indices[2] - first_vertex;
    if (3 * (count - i) > kAhead + 3)
      for (std::uint32_t k = 0; k < 3; ++k) prefetch(vertices[indices[kAhead + k] - first_vertex]);
    const ShadedVertex &a = vertices[v0], &b = vertices[v1], &c = vertices[v2];
    if ((a.outcode & b.outcode & c.outcode) != 0 || a.needs_clip || b.needs_clip || c.needs_clip) {
      add_triangle(v0, v1, v2);
      continue;
    }
    TrianglePlace place;
    const SetupResult result = place_triangle(a.screen, b.screen, c.screen, rules_, place);
    results[static_cast<std::size_t>(result)] += 1;
    if (result == SetupResult::drawn)
      out.push_back({{a.screen, b.screen, c.screen}, {v0, v1, v2}, primitive_, place, 0});
  }
  return results;
}

ClipVertex PrimitiveSetup::clip_vertex(std::uint32_t v, std::size_t corner) const {
  ClipVertex out;
  for (std::size_t k = 0; k < 4; ++k) out.position[k] = source_.vertices[v].clip_position[k];
  out.weights[corner] = 1.0;
  return out;
}

void PrimitiveSetup::cull_outside() {
  counters_->setup.in_primitives += 1;
  counters_->setup.culled_frustum_primitives += 1;
}

std::uint32_t PrimitiveSetup::own_vertices() const {
  return static_cast<std::uint32_t>(source_.scalars == 0 ? 0 : item_.own_varyings.size() / source_.scalars);
}

std::uint32_t PrimitiveSetup::kept_vertex(std::uint32_t v) {
  if (!source_.temporary) return v;
  const std::uint32_t kept = own_vertices() | kOwnVertexBit;
  const float* from = source_.varyings + v * source_.stride;
  item_.own_varyings.insert(item_.own_varyings.end(), from, from + source_.scalars);
  return kept;
}

void PrimitiveSetup::append_varyings(const Vertices& v, const std::array<double, 3>& weights) {
  for (std::size_t k = 0; k < source_.scalars; ++k) {
    double value = 0.0;
    for (std::size_t i = 0; i < 3; ++i) value += weights[i] * source_.varyings[v[i] * source_.stride + k];
    item_.own_varyings.push_back(static_cast<float>(value));
  }
}

void PrimitiveSetup::add_clipped(const Vertices& v) {
  std::array<ClipVertex, kMaxClippedVertices> polygon;
  const int count =
      clip_triangle({clip_vertex(v[0], 0), clip_vertex(v[1], 1), clip_vertex(v[2], 2)}, band_, polygon);
  bool usable = count >= 3;
  for (int i = 0; i < count; ++i) usable = usable && polygon[static_cast<std::size_t>(i)].position[3] > 1e-30;
  if (!usable) return cull_outside();
  const std::uint32_t first = own_vertices();
  std::array<ScreenVertex, kMaxClippedVertices> corner;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    corner[i] = to_screen(polygon[i].position.data(), c_.width, c_.height);
    append_varyings(v, polygon[i].weights);
  }
  const auto own = [first](std::size_t i) { return (first + static_cast<std::uint32_t>(i)) | kOwnVertexBit; };
  for (std::size_t i = 1; i + 1 < static_cast<std::size_t>(count); ++i) {
    counters_->stats.clipping_primitives += 1;
    const ScreenVertex screen[3] = {corner[0], corner[i], corner[i + 1]};
    place(screen, {own(0), own(i), own(i + 1)});
  }
}

// Setup and rasterization once for each viewport; what comes before, once.
void PrimitiveSetup::place(const ScreenVertex (&screen)[3], const Vertices& v) {
  const std::size_t layers = c_.viewports.size();
  std::array<TrianglePlace, kMaxViewports> places;
  std::array<SetupResult, kMaxViewports> results;
  if (layers == 1)
    results[0] = place_triangle(screen[0], screen[1], screen[2], rules_, places[0]);
  else
    place_triangle(screen, rules_, c_.viewports, std::span(places).first(layers),
                   std::span(results).first(layers));
  for (std::size_t l = 0; l < layers; ++l) {
    count(results[l]);
    if (results[l] == SetupResult::drawn)
      item_.built->triangles.push_back({{screen[0], screen[1], screen[2]},
                                        {v[0], v[1], v[2]},
                                        primitive_,
                                        places[l],
                                        static_cast<std::int16_t>(l)});
  }
}

void PrimitiveSetup::count(SetupResult result, std::uint64_t triangles) {
  SetupCounters& n = counters_->setup;
  n.in_primitives += triangles;
  switch (result) {
    case SetupResult::backface:
      n.culled_backface_primitives += triangles;
      break;
    case SetupResult::zero_area:
      n.culled_zero_area_primitives += triangles;
      break;
    case SetupResult::sample_miss:
      n.culled_sample_miss_primitives += triangles;
      break;
    case SetupResult::drawn:
      n.out_primitives += triangles;
      break;
  }
}

}  // namespace hwsim::pipeline
