#include "pipeline/emulate/primitive_setup.h"

#include <cmath>

namespace hwsim::pipeline {
namespace {

bool in_guard_band(const double* p, const GuardBand& band) {
  return p[3] > 0 && p[2] >= 0 && p[2] <= p[3] && p[0] >= band.min_x * p[3] && p[0] <= band.max_x * p[3] &&
         p[1] >= band.min_y * p[3] && p[1] <= band.max_y * p[3];
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
  set_up(screen, {kept_vertex(v0), kept_vertex(v1), kept_vertex(v2)});
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
  return static_cast<std::uint32_t>(source_.scalars == 0 ? 0
                                                         : item_.clipped_varyings.size() / source_.scalars);
}

std::uint32_t PrimitiveSetup::kept_vertex(std::uint32_t v) {
  if (!source_.temporary) return v;
  const std::uint32_t kept = own_vertices() | kClippedVertexBit;
  const float* from = source_.varyings + v * source_.stride;
  item_.clipped_varyings.insert(item_.clipped_varyings.end(), from, from + source_.scalars);
  return kept;
}

void PrimitiveSetup::add_clipped(const Vertices& v) {
  std::array<ClipVertex, kMaxClippedVertices> polygon;
  const int count =
      clip_triangle({clip_vertex(v[0], 0), clip_vertex(v[1], 1), clip_vertex(v[2], 2)}, band_, polygon);
  bool usable = count >= 3;
  for (int i = 0; i < count; ++i) usable = usable && polygon[static_cast<std::size_t>(i)].position[3] > 1e-30;
  if (!usable) return cull_outside();
  const std::uint32_t first = own_vertices();
  for (int i = 0; i < count; ++i) append_varyings(v, polygon[static_cast<std::size_t>(i)].weights);
  for (int i = 1; i + 1 < count; ++i) {
    const int fan[3] = {0, i, i + 1};
    ScreenVertex screen[3];
    Vertices index;
    for (std::size_t k = 0; k < 3; ++k) {
      screen[k] = to_screen(polygon[static_cast<std::size_t>(fan[k])].position.data(), c_.width, c_.height);
      index[k] = (first + static_cast<std::uint32_t>(fan[k])) | kClippedVertexBit;
    }
    counters_->stats.clipping_primitives += 1;
    set_up(screen, index);
  }
}

void PrimitiveSetup::append_varyings(const Vertices& v, const std::array<double, 3>& weights) {
  for (std::size_t k = 0; k < source_.scalars; ++k) {
    double value = 0.0;
    for (std::size_t i = 0; i < 3; ++i) value += weights[i] * source_.varyings[v[i] * source_.stride + k];
    item_.clipped_varyings.push_back(static_cast<float>(value));
  }
}

// Setup and rasterization once for each viewport; what comes before, once.
void PrimitiveSetup::set_up(const ScreenVertex (&screen)[3], const Vertices& v) {
  const std::size_t layers = c_.viewports.size();
  if (layers == 1) {
    RasterTriangle t;
    finish(set_up_triangle(screen, rules_, t), v, t);
    return;
  }
  std::array<RasterTriangle, kMaxViewports> triangles;
  std::array<SetupResult, kMaxViewports> results;
  set_up_triangle(screen, rules_, c_.viewports, std::span(triangles).first(layers),
                  std::span(results).first(layers));
  for (std::size_t l = 0; l < layers; ++l) finish(results[l], v, triangles[l]);
}

void PrimitiveSetup::finish(SetupResult result, const Vertices& v, RasterTriangle& t) {
  count(result);
  if (result != SetupResult::drawn) return;
  for (std::size_t i = 0; i < 3; ++i) t.vertex[i] = v[i];
  t.draw = item_.draw;
  t.chunk = primitive_ / c_.chunk_primitives;
  t.primitive = primitive_;
  item_.triangles.push_back(t);
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
