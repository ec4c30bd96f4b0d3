// Points and line strips become quadrilaterals in screen space, two triangles each; those of a point are set
// up where they are rasterized.
#include <algorithm>
#include <cmath>

#include "pipeline/emulate/primitive_setup.h"

namespace hwsim::pipeline {

/// Corners in order around it, attributes of the vertices given.
void PrimitiveSetup::add_quad(const std::array<ScreenVertex, 4>& corner,
                              const std::array<std::uint32_t, 4>& v) {
  counters_->stats.clipping_primitives += 1;
  for (const std::size_t i : {std::size_t{1}, std::size_t{2}}) {
    const ScreenVertex screen[3] = {corner[0], corner[i], corner[i + 1]};
    place(screen, {v[0], v[i], v[i + 1]});
  }
}

std::int32_t point_half(const PipelineState& state) {
  return static_cast<std::int32_t>(std::lround(state.raster.primitive_size_px * 0.5f * kSubpixelUnits));
}

void PrimitiveSetup::add_point(std::uint32_t v) {
  counters_->stats.clipping_invocations += 1;
  const ShadedVertex& vertex = source_.vertices[v];
  if (vertex.outcode != 0) return cull_outside();  // by its center, as Direct3D does
  if (c_.viewports.size() == 1) return keep_point(vertex.screen, v);
  const std::int32_t half = point_half(draw_.batch->state);
  std::array<ScreenVertex, 4> corner;
  corner.fill(vertex.screen);
  for (std::size_t i = 0; i < 4; ++i) {
    corner[i].x += i == 1 || i == 2 ? half : -half;
    corner[i].y += i >= 2 ? half : -half;
  }
  const std::uint32_t kept = kept_vertex(v);
  add_quad(corner, {kept, kept, kept, kept});
}

// Both triangles have the square's bounding box, so that they share their fate.
void PrimitiveSetup::keep_point(const ScreenVertex& center, std::uint32_t v) {
  counters_->stats.clipping_primitives += 1;
  const std::int32_t half = point_half(draw_.batch->state);
  RasterPoint p{center.x, center.y, center.z, center.inv_w, 0, primitive_ / c_.chunk_primitives, primitive_};
  PixelRectangle bounds;
  if (half == 0) return count(SetupResult::zero_area, 2);
  if (!find_point_bounds(p, half, rules_, bounds)) return count(SetupResult::sample_miss, 2);
  count(SetupResult::drawn, 2);
  p.vertex = kept_vertex(v);
  item_.built->points.push_back(p);
}

void PrimitiveSetup::add_line(std::uint32_t a, std::uint32_t b) {
  counters_->stats.clipping_invocations += 1;
  if ((source_.vertices[a].outcode & source_.vertices[b].outcode) != 0) return cull_outside();
  std::array<ClipVertex, kMaxClippedVertices> ends;
  const int count = clip_triangle({clip_vertex(a, 0), clip_vertex(b, 1), clip_vertex(b, 1)}, band_, ends);
  if (count < 3) return cull_outside();
  // A triangle without width comes back as its clipped segment: the ends are the extremes of vertex 0's
  // weight.
  const auto [to, from] = std::minmax_element(
      ends.begin(), ends.begin() + count,
      [](const ClipVertex& p, const ClipVertex& q) { return p.weights[0] < q.weights[0]; });
  if (from->position[3] <= 1e-30 || to->position[3] <= 1e-30) return cull_outside();
  const std::uint32_t first = own_vertices();
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
  const std::uint32_t i = first | kOwnVertexBit, j = (first + 1) | kOwnVertexBit;
  add_quad({moved(p, nx, ny), moved(q, nx, ny), moved(q, -nx, -ny), moved(p, -nx, -ny)}, {i, j, j, i});
}

}  // namespace hwsim::pipeline
