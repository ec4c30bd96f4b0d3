#include "pipeline/raster/triangle.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

#include "pipeline/raster/triangle_setup.h"

namespace hwsim::pipeline {
namespace {

constexpr std::int64_t floor_div16(std::int64_t value) { return value >> 4; }

// Edge from p to q with the inside on its right on screen (y down, clockwise order): E = a X + b Y + c.
// A sample on the edge is inside only on a top edge (horizontal, going right) or a left edge (going up).
void set_edge(const ScreenVertex& p, const ScreenVertex& q, int i, RasterTriangle& t) {
  const std::int32_t a = p.y - q.y;
  const std::int32_t b = q.x - p.x;
  const bool top_left = a > 0 || (a == 0 && b > 0);
  const std::int64_t c = -(std::int64_t{a} * p.x + std::int64_t{b} * p.y) - (top_left ? 0 : 1);
  t.a[i] = a;
  t.b[i] = b;
  t.c[i] = floor_div16(c);  // exact: 16 (aX + bY) + c >= 0  <=>  aX + bY + floor(c / 16) >= 0
}

void move(ViewportShift shift, ScreenVertex (&v)[3]) {
  for (ScreenVertex& vertex : v) {
    vertex.x += shift.x;
    vertex.y += shift.y;
  }
}

// A pixel is touched iff no edge excludes all of it: move each edge outward by its support over the pixel
// square, and treat touching the boundary as touching (conservative overestimation).
void grow_edges(RasterTriangle& t) {
  for (int i = 0; i < 3; ++i) {
    const std::int64_t support = 8 * (std::int64_t{std::abs(t.a[i])} + std::abs(t.b[i]));
    t.c[i] += support + 1;
  }
}

PlaneEquation make_plane(const TriangleSlopes& g, double v0, double v1, double v2) {
  const double dx = (v1 - v0) * g.l1_dx + (v2 - v0) * g.l2_dx;
  const double dy = (v1 - v0) * g.l1_dy + (v2 - v0) * g.l2_dy;
  return {static_cast<float>(v0 - dx * g.x0 - dy * g.y0), static_cast<float>(dx), static_cast<float>(dy)};
}

}  // namespace

void place_triangle(const ScreenVertex (&v)[3], const SetupRules& rules,
                    std::span<const ViewportShift> viewports, std::span<TrianglePlace> places,
                    std::span<SetupResult> results) {
  const SetupResult result = cull_by_area(doubled_area(v[0], v[1], v[2]), rules);
  if (result != SetupResult::drawn) {
    std::ranges::fill(results, result);
    return;
  }
  int reference_x = std::numeric_limits<int>::max(), reference_y = reference_x;
  for (std::size_t l = 0; l < viewports.size(); ++l) {
    ScreenVertex moved[3] = {v[0], v[1], v[2]};
    move(viewports[l], moved);
    const PixelBounds bounds = find_bounds(moved[0], moved[1], moved[2], rules);
    reference_x = std::min(reference_x, bounds.first_x);
    reference_y = std::min(reference_y, bounds.first_y);
    results[l] = set_bounds(bounds, rules, places[l]) ? SetupResult::drawn : SetupResult::sample_miss;
  }
  for (std::size_t l = 0; l < viewports.size(); ++l) {
    if (results[l] != SetupResult::drawn) continue;
    places[l].reference_x = static_cast<std::int16_t>(std::max(reference_x, 0));
    places[l].reference_y = static_cast<std::int16_t>(std::max(reference_y, 0));
  }
}

TriangleSlopes set_up_depth(const ScreenVertex (&v)[3], const TrianglePlace& place, ViewportShift shift,
                            bool conservative, RasterTriangle& t) {
  const std::int64_t area2 = doubled_area(v[0], v[1], v[2]);
  // Clockwise on screen: the inside is where the edge functions are positive.
  const std::size_t second = area2 > 0 ? 1 : 2;
  const std::size_t third = 3 - second;
  ScreenVertex moved[3] = {v[0], v[1], v[2]};
  move(shift, moved);
  set_edge(moved[0], moved[second], 0, t);
  set_edge(moved[second], moved[third], 1, t);
  set_edge(moved[third], moved[0], 2, t);
  if (conservative) grow_edges(t);
  t.front_facing = area2 < 0;  // y down: counterclockwise with y up is a negative area
  t.min_x = place.min_x;
  t.min_y = place.min_y;
  t.max_x = place.max_x;
  t.max_y = place.max_y;
  t.reference_x = static_cast<float>(place.reference_x) + static_cast<float>(shift.x) / kSubpixelUnits;
  t.reference_y = static_cast<float>(place.reference_y) + static_cast<float>(shift.y) / kSubpixelUnits;
  constexpr double kPx = 1.0 / kSubpixelUnits;
  // Twice the area in 1/256 px squared; lambda1 = cross(p - v0, v2 - v0) / cross(v1 - v0, v2 - v0).
  const double scale = kSubpixelUnits / static_cast<double>(area2);
  TriangleSlopes g;
  g.x0 = v[0].x * kPx - place.reference_x;
  g.y0 = v[0].y * kPx - place.reference_y;
  g.l1_dx = static_cast<double>(v[2].y - v[0].y) * scale;
  g.l1_dy = -static_cast<double>(v[2].x - v[0].x) * scale;
  g.l2_dx = -static_cast<double>(v[1].y - v[0].y) * scale;
  g.l2_dy = static_cast<double>(v[1].x - v[0].x) * scale;
  t.z = make_plane(g, v[0].z, v[1].z, v[2].z);
  return g;
}

void set_up_attributes(const ScreenVertex (&v)[3], const TriangleSlopes& g, RasterTriangle& t) {
  t.inv_w = make_plane(g, v[0].inv_w, v[1].inv_w, v[2].inv_w);
  t.l1_w = make_plane(g, 0.0, v[1].inv_w, 0.0);
  t.l2_w = make_plane(g, 0.0, 0.0, v[2].inv_w);
}

SetupResult set_up_triangle(const ScreenVertex (&v)[3], const SetupRules& rules, RasterTriangle& t) {
  constexpr ViewportShift kNone{};
  SetupResult result = SetupResult::drawn;
  set_up_triangle(v, rules, std::span(&kNone, 1), std::span(&t, 1), std::span(&result, 1));
  return result;
}

void set_up_triangle(const ScreenVertex (&v)[3], const SetupRules& rules,
                     std::span<const ViewportShift> viewports, std::span<RasterTriangle> triangles,
                     std::span<SetupResult> results) {
  std::array<TrianglePlace, kMaxViewports> places;
  place_triangle(v, rules, viewports, std::span(places).first(viewports.size()), results);
  for (std::size_t l = 0; l < viewports.size(); ++l) {
    if (results[l] != SetupResult::drawn) continue;
    set_up_attributes(v, set_up_depth(v, places[l], viewports[l], rules.conservative, triangles[l]),
                      triangles[l]);
    triangles[l].layer = static_cast<std::int32_t>(l);
  }
}

bool find_point_bounds(const RasterPoint& p, std::int32_t half, const SetupRules& rules,
                       PixelRectangle& bounds) {
  return clip_bounds(find_bounds(p.x - half, p.x + half, p.y - half, p.y + half, rules), rules, bounds);
}

void set_up_point(const RasterPoint& p, std::int32_t half, bool upper, const SetupRules& rules,
                  RasterTriangle& t) {
  const ScreenVertex corner[4] = {{p.x - half, p.y - half, p.z, p.inv_w},
                                  {p.x + half, p.y - half, p.z, p.inv_w},
                                  {p.x + half, p.y + half, p.z, p.inv_w},
                                  {p.x - half, p.y + half, p.z, p.inv_w}};
  const std::size_t second = upper ? 1 : 2;
  set_up_triangle({corner[0], corner[second], corner[second + 1]}, rules, t);
  std::fill(t.vertex, t.vertex + 3, p.vertex);
  t.chunk = p.chunk;
  t.primitive = p.primitive;
}

// make_plane with equal values at the vertices, and barycentric coordinates whose gradients are 1, 0 or -1.
void set_point_planes(const RasterPoint& p, const PointPixel& pixel, RasterTriangle& t) {
  constexpr double kPx = 1.0 / kSubpixelUnits;
  const double w = p.inv_w;
  const double x = w * ((p.x - kSubpixelUnits / 2) * kPx - pixel.x),  // corner 0 from the reference pixel
      y = w * ((p.y - kSubpixelUnits / 2) * kPx - pixel.y);
  t.reference_x = static_cast<float>(pixel.x);
  t.reference_y = static_cast<float>(pixel.y);
  t.z = {p.z, 0.0f, 0.0f};
  t.inv_w = {p.inv_w, 0.0f, 0.0f};
  if (pixel.upper) {
    t.l1_w = {static_cast<float>(0.0 - x + y), p.inv_w, -p.inv_w};
    t.l2_w = {static_cast<float>(0.0 - y), 0.0f, p.inv_w};
  } else {
    t.l1_w = {static_cast<float>(0.0 - x), p.inv_w, 0.0f};
    t.l2_w = {static_cast<float>(0.0 + x - y), -p.inv_w, p.inv_w};
  }
  std::fill(t.vertex, t.vertex + 3, p.vertex);
  t.front_facing = false;
  t.layer = 0;
  t.chunk = p.chunk;
  t.primitive = p.primitive;
}

}  // namespace hwsim::pipeline
