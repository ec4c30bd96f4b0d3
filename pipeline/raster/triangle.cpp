#include "pipeline/raster/triangle.h"

#include <algorithm>
#include <cstdlib>

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

bool set_bounds(const ScreenVertex (&v)[3], const SetupRules& rules, RasterTriangle& t) {
  const auto [low_x, high_x] = std::minmax({v[0].x, v[1].x, v[2].x});
  const auto [low_y, high_y] = std::minmax({v[0].y, v[1].y, v[2].y});
  int first_x, last_x, first_y, last_y;
  if (rules.conservative) {
    first_x = (low_x - 1) >> kSubpixelBits;
    last_x = high_x >> kSubpixelBits;
    first_y = (low_y - 1) >> kSubpixelBits;
    last_y = high_y >> kSubpixelBits;
  } else {
    sample_bounds(low_x, high_x, rules.sample_min_x, rules.sample_max_x, first_x, last_x);
    sample_bounds(low_y, high_y, rules.sample_min_y, rules.sample_max_y, first_y, last_y);
  }
  first_x = std::max(first_x, 0);
  first_y = std::max(first_y, 0);
  last_x = std::min(last_x, rules.width_px - 1);
  last_y = std::min(last_y, rules.height_px - 1);
  if (first_x > last_x || first_y > last_y) return false;
  t.min_x = static_cast<std::int16_t>(first_x);
  t.min_y = static_cast<std::int16_t>(first_y);
  t.max_x = static_cast<std::int16_t>(last_x);
  t.max_y = static_cast<std::int16_t>(last_y);
  return true;
}

struct Gradients {
  double x0, y0;                      // vertex 0 relative to the reference pixel, px
  double l1_dx, l1_dy, l2_dx, l2_dy;  // of the barycentric coordinates, per px
};

PlaneEquation make_plane(const Gradients& g, double v0, double v1, double v2) {
  const double dx = (v1 - v0) * g.l1_dx + (v2 - v0) * g.l2_dx;
  const double dy = (v1 - v0) * g.l1_dy + (v2 - v0) * g.l2_dy;
  return {static_cast<float>(v0 - dx * g.x0 - dy * g.y0), static_cast<float>(dx), static_cast<float>(dy)};
}

void set_planes(const ScreenVertex& v0, const ScreenVertex& v1, const ScreenVertex& v2, std::int64_t area2,
                RasterTriangle& t) {
  t.reference_x = t.min_x;
  t.reference_y = t.min_y;
  constexpr double kPx = 1.0 / kSubpixelUnits;
  // Twice the area in 1/256 px squared; lambda1 = cross(p - v0, v2 - v0) / cross(v1 - v0, v2 - v0).
  const double scale = kSubpixelUnits / static_cast<double>(area2);
  Gradients g;
  g.x0 = v0.x * kPx - t.reference_x;
  g.y0 = v0.y * kPx - t.reference_y;
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
  const std::int64_t area2 =
      std::int64_t{v[1].x - v[0].x} * (v[2].y - v[0].y) - std::int64_t{v[2].x - v[0].x} * (v[1].y - v[0].y);
  if (area2 == 0) return SetupResult::zero_area;
  t.front_facing = area2 < 0;  // y down: counterclockwise with y up is a negative area
  if ((rules.cull_back && !t.front_facing) || (rules.cull_front && t.front_facing))
    return SetupResult::backface;
  if (!set_bounds(v, rules, t)) return SetupResult::sample_miss;
  const int second =
      area2 > 0 ? 1 : 2;  // clockwise on screen: the inside is where the edge functions are positive
  const int third = 3 - second;
  set_edge(v[0], v[second], 0, t);
  set_edge(v[second], v[third], 1, t);
  set_edge(v[third], v[0], 2, t);
  if (rules.conservative) grow_edges(t);
  set_planes(v[0], v[1], v[2], area2, t);
  return SetupResult::drawn;
}

}  // namespace hwsim::pipeline
