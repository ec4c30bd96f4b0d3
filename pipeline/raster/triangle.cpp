#include "pipeline/raster/triangle.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

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

// A pixel is touched iff no edge excludes all of it: move each edge outward by its support over the pixel
// square, and treat touching the boundary as touching (conservative overestimation).
void grow_edges(RasterTriangle& t) {
  for (int i = 0; i < 3; ++i) {
    const std::int64_t support = 8 * (std::int64_t{std::abs(t.a[i])} + std::abs(t.b[i]));
    t.c[i] += support + 1;
  }
}

// First pixel column (or row) with a sample at or right of `low`, and last with one at or left of `high`;
// 1/256 px.
void sample_bounds(std::int32_t low, std::int32_t high, int sample_low, int sample_high, int& first,
                   int& last) {
  // pixel p has samples from 256 p + 128 + 16 sample_low to 256 p + 128 + 16 sample_high
  const std::int32_t to_last_sample = 128 + 16 * sample_high;
  const std::int32_t to_first_sample = 128 + 16 * sample_low;
  first = (low - to_last_sample + kSubpixelUnits - 1) >> kSubpixelBits;
  last = (high - to_first_sample) >> kSubpixelBits;
}

/// Pixels that can hold covered samples, not yet clipped to the viewport.
struct PixelBounds {
  int first_x, last_x, first_y, last_y;
};

PixelBounds find_bounds(std::int32_t low_x, std::int32_t high_x, std::int32_t low_y, std::int32_t high_y,
                        const SetupRules& rules) {
  if (rules.conservative)
    return {(low_x - 1) >> kSubpixelBits, high_x >> kSubpixelBits, (low_y - 1) >> kSubpixelBits,
            high_y >> kSubpixelBits};
  PixelBounds b;
  sample_bounds(low_x, high_x, rules.sample_min_x, rules.sample_max_x, b.first_x, b.last_x);
  sample_bounds(low_y, high_y, rules.sample_min_y, rules.sample_max_y, b.first_y, b.last_y);
  return b;
}

PixelBounds find_bounds(const ScreenVertex (&v)[3], const SetupRules& rules) {
  const auto [low_x, high_x] = std::minmax({v[0].x, v[1].x, v[2].x});
  const auto [low_y, high_y] = std::minmax({v[0].y, v[1].y, v[2].y});
  return find_bounds(low_x, high_x, low_y, high_y, rules);
}

bool clip_bounds(const PixelBounds& b, const SetupRules& rules, PixelRectangle& r) {
  r = {std::max(b.first_x, 0), std::max(b.first_y, 0), std::min(b.last_x, rules.width_px - 1),
       std::min(b.last_y, rules.height_px - 1)};
  return r.min_x <= r.max_x && r.min_y <= r.max_y;
}

bool set_bounds(const PixelBounds& b, const SetupRules& rules, RasterTriangle& t) {
  PixelRectangle r;
  if (!clip_bounds(b, rules, r)) return false;
  t.min_x = static_cast<std::int16_t>(r.min_x);
  t.min_y = static_cast<std::int16_t>(r.min_y);
  t.max_x = static_cast<std::int16_t>(r.max_x);
  t.max_y = static_cast<std::int16_t>(r.max_y);
  return true;
}

struct Gradients {
  double x0, y0;                      // vertex 0 relative to the reference pixel, px
  double l1_dx, l1_dy, l2_dx, l2_dy;  // slopes of the barycentric coordinates, per px
};

PlaneEquation make_plane(const Gradients& g, double v0, double v1, double v2) {
  const double dx = (v1 - v0) * g.l1_dx + (v2 - v0) * g.l2_dx;
  const double dy = (v1 - v0) * g.l1_dy + (v2 - v0) * g.l2_dy;
  return {static_cast<float>(v0 - dx * g.x0 - dy * g.y0), static_cast<float>(dx), static_cast<float>(dy)};
}

void set_planes(const ScreenVertex& v0, const ScreenVertex& v1, const ScreenVertex& v2, std::int64_t area2,
                int reference_x, int reference_y, RasterTriangle& t) {
  constexpr double kPx = 1.0 / kSubpixelUnits;
  // Twice the area in 1/256 px squared; lambda1 = cross(p - v0, v2 - v0) / cross(v1 - v0, v2 - v0).
  const double scale = kSubpixelUnits / static_cast<double>(area2);
  Gradients g;
  g.x0 = v0.x * kPx - reference_x;
  g.y0 = v0.y * kPx - reference_y;
  g.l1_dx = static_cast<double>(v2.y - v0.y) * scale;
  g.l1_dy = -static_cast<double>(v2.x - v0.x) * scale;
  g.l2_dx = -static_cast<double>(v1.y - v0.y) * scale;
  g.l2_dy = static_cast<double>(v1.x - v0.x) * scale;
  t.z = make_plane(g, v0.z, v1.z, v2.z);
  t.inv_w = make_plane(g, v0.inv_w, v1.inv_w, v2.inv_w);
  t.l1_w = make_plane(g, 0.0, v1.inv_w, 0.0);
  t.l2_w = make_plane(g, 0.0, 0.0, v2.inv_w);
}

}  // namespace

SetupResult set_up_triangle(const ScreenVertex (&v)[3], const SetupRules& rules, RasterTriangle& t) {
  constexpr ViewportShift kNone{};
  SetupResult result = SetupResult::drawn;
  set_up_triangle(v, rules, std::span(&kNone, 1), std::span(&t, 1), std::span(&result, 1));
  return result;
}

void set_up_triangle(const ScreenVertex (&v)[3], const SetupRules& rules,
                     std::span<const ViewportShift> viewports, std::span<RasterTriangle> triangles,
                     std::span<SetupResult> results) {
  const std::int64_t area2 =
      std::int64_t{v[1].x - v[0].x} * (v[2].y - v[0].y) - std::int64_t{v[2].x - v[0].x} * (v[1].y - v[0].y);
  const bool front_facing = area2 < 0;  // y down: counterclockwise with y up is a negative area
  const bool culled = (rules.cull_back && !front_facing) || (rules.cull_front && front_facing);
  if (area2 == 0 || culled) {
    std::ranges::fill(results, area2 == 0 ? SetupResult::zero_area : SetupResult::backface);
    return;
  }
  // Clockwise on screen: the inside is where the edge functions are positive.
  const std::size_t second = area2 > 0 ? 1 : 2;
  const std::size_t third = 3 - second;
  int reference_x = std::numeric_limits<int>::max(), reference_y = reference_x;
  bool any = false;
  for (std::size_t l = 0; l < viewports.size(); ++l) {
    const ViewportShift shift = viewports[l];
    ScreenVertex moved[3] = {v[0], v[1], v[2]};
    for (ScreenVertex& vertex : moved) {
      vertex.x += shift.x;
      vertex.y += shift.y;
    }
    const PixelBounds bounds = find_bounds(moved, rules);
    reference_x = std::min(reference_x, bounds.first_x);
    reference_y = std::min(reference_y, bounds.first_y);
    RasterTriangle& t = triangles[l];
    results[l] = set_bounds(bounds, rules, t) ? SetupResult::drawn : SetupResult::sample_miss;
    if (results[l] != SetupResult::drawn) continue;
    any = true;
    set_edge(moved[0], moved[second], 0, t);
    set_edge(moved[second], moved[third], 1, t);
    set_edge(moved[third], moved[0], 2, t);
    if (rules.conservative) grow_edges(t);
    t.front_facing = front_facing;
    t.layer = static_cast<std::int32_t>(l);
  }
  if (!any) return;
  reference_x = std::max(reference_x, 0);
  reference_y = std::max(reference_y, 0);
  RasterTriangle planes;
  set_planes(v[0], v[1], v[2], area2, reference_x, reference_y, planes);
  for (std::size_t l = 0; l < viewports.size(); ++l) {
    if (results[l] != SetupResult::drawn) continue;
    RasterTriangle& t = triangles[l];
    t.z = planes.z;
    t.inv_w = planes.inv_w;
    t.l1_w = planes.l1_w;
    t.l2_w = planes.l2_w;
    t.reference_x = static_cast<float>(reference_x) + static_cast<float>(viewports[l].x) / kSubpixelUnits;
    t.reference_y = static_cast<float>(reference_y) + static_cast<float>(viewports[l].y) / kSubpixelUnits;
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
