#include "oracle/random_triangles.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace hwsim::oracle {
namespace {

constexpr std::int32_t kSampleGrid = 16;  // every standard sample lies on a multiple of 1/16 px
constexpr std::int32_t kGuardBandPx = (1 << 15) - 1;

// Twice the area.
std::int64_t area(const FixedTriangle& t) {
  const auto& [a, b, c] = t.vertices;
  return (std::int64_t{b.x} - a.x) * (std::int64_t{c.y} - a.y) -
         (std::int64_t{b.y} - a.y) * (std::int64_t{c.x} - a.x);
}

}  // namespace

const char* name(TriangleKind kind) {
  switch (kind) {
    case TriangleKind::general:
      return "general";
    case TriangleKind::sliver:
      return "sliver";
    case TriangleKind::tie:
      return "tie";
    case TriangleKind::axis_aligned:
      return "axis aligned";
    case TriangleKind::tiny:
      return "tiny";
    case TriangleKind::large:
      return "large";
    case TriangleKind::guard_band:
      return "guard band";
  }
  return "unknown";
}

std::int32_t TriangleGenerator::between(std::int32_t low, std::int32_t high) {
  return low + static_cast<std::int32_t>(random_() % static_cast<std::uint32_t>(high - low + 1));
}

FixedVertex TriangleGenerator::in_target(std::int32_t margin_px, std::int32_t grid) {
  const std::int32_t steps_per_px = kSubpixelsPerPixel / grid;
  FixedVertex v;
  v.x = between(-margin_px * steps_per_px, (width_ + margin_px) * steps_per_px) * grid;
  v.y = between(-margin_px * steps_per_px, (height_ + margin_px) * steps_per_px) * grid;
  v.depth = static_cast<float>(between(1, 65535)) / 65536.0f;
  return v;
}

FixedTriangle TriangleGenerator::sliver() {
  FixedTriangle t{{in_target(8, 1), in_target(8, 1), {}}};
  const auto& [a, b, _] = t.vertices;
  const std::int32_t along = between(0, 16);
  t.vertices[2] = {a.x + (b.x - a.x) / 16 * along + between(-40, 40),
                   a.y + (b.y - a.y) / 16 * along + between(-40, 40), a.depth};
  return t;
}

FixedTriangle TriangleGenerator::axis_aligned() {
  const std::int32_t grid = between(0, 1) ? kSampleGrid : 1;
  FixedTriangle t{{in_target(4, grid), in_target(4, grid), in_target(4, grid)}};
  t.vertices[1].y = t.vertices[0].y;
  if (between(0, 1)) t.vertices[2].x = t.vertices[between(0, 1) ? 0 : 1].x;
  return t;
}

FixedTriangle TriangleGenerator::tiny() {
  FixedTriangle t{{in_target(1, 1), {}, {}}};
  for (std::size_t i : {1u, 2u}) {
    t.vertices[i] = t.vertices[0];
    t.vertices[i].x += between(-256, 256);
    t.vertices[i].y += between(-256, 256);
  }
  return t;
}

FixedTriangle TriangleGenerator::one(TriangleKind kind) {
  const auto three = [&](std::int32_t margin_px, std::int32_t grid) {
    return FixedTriangle{
        {in_target(margin_px, grid), in_target(margin_px, grid), in_target(margin_px, grid)}};
  };
  switch (kind) {
    case TriangleKind::general:
      return three(16, 1);
    case TriangleKind::sliver:
      return sliver();
    case TriangleKind::tie:
      return three(2, kSampleGrid);
    case TriangleKind::axis_aligned:
      return axis_aligned();
    case TriangleKind::tiny:
      return tiny();
    case TriangleKind::large:
      return three(900, between(0, 1) ? 1 : kSampleGrid);
    case TriangleKind::guard_band:
      return three(kGuardBandPx - std::max(width_, height_), 1);
  }
  return {};
}

std::vector<FixedTriangle> TriangleGenerator::make(TriangleKind kind, int count) {
  std::vector<FixedTriangle> triangles;
  for (int i = 0; i < count; ++i) triangles.push_back(one(kind));
  return triangles;
}

std::vector<FixedTriangle> TriangleGenerator::fan(int count) {
  const FixedVertex center = in_target(0, kSampleGrid);
  std::vector<FixedVertex> rim;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    const double radius = between(256 * 4, 256 * std::max(8, std::min(width_, height_) / 2));
    const auto on_grid = [](double value) {
      return static_cast<std::int32_t>(std::lround(value / kSampleGrid)) * kSampleGrid;
    };
    rim.push_back(
        {center.x + on_grid(radius * std::cos(angle)), center.y + on_grid(radius * std::sin(angle)), 0.5f});
  }
  std::vector<FixedTriangle> triangles;
  for (std::size_t i = 0; i < rim.size(); ++i)
    triangles.push_back({{center, rim[i], rim[(i + 1) % rim.size()]}});
  return triangles;
}

// A split puts a vertex onto a triangle's inside (three triangles in its place); vertices on edges would
// leave gaps only if snapping moved them, which the 1/256 grid forbids, so interior points alone are used.
std::vector<FixedTriangle> TriangleGenerator::partition(int splits) {
  const std::int32_t right = width_ * kSubpixelsPerPixel, bottom = height_ * kSubpixelsPerPixel;
  const FixedVertex a{0, 0, 0.5f}, b{right, 0, 0.5f}, c{right, bottom, 0.5f}, d{0, bottom, 0.5f};
  std::vector<FixedTriangle> triangles = {{{a, b, c}}, {{a, c, d}}};
  for (int i = 0; i < splits; ++i) {
    const auto which = static_cast<std::size_t>(between(0, static_cast<std::int32_t>(triangles.size()) - 1));
    const auto [p, q, r] = triangles[which].vertices;
    const std::int32_t u = between(1, 30), v = between(1, 31 - u);
    const FixedVertex inside{p.x + (q.x - p.x) / 32 * u + (r.x - p.x) / 32 * v,
                             p.y + (q.y - p.y) / 32 * u + (r.y - p.y) / 32 * v, 0.5f};
    const FixedTriangle parts[] = {{{p, q, inside}}, {{q, r, inside}}, {{r, p, inside}}};
    const std::int64_t whole = area(triangles[which]);
    const bool is_inside = std::all_of(std::begin(parts), std::end(parts), [&](const FixedTriangle& part) {
      return (area(part) > 0) == (whole > 0) && area(part);
    });
    if (!is_inside) continue;  // rounding has moved the point out of a thin triangle
    triangles[which] = parts[0];
    triangles.insert(triangles.end(), {parts[1], parts[2]});
  }
  for (FixedTriangle& t : triangles)
    if (between(0, 1)) std::swap(t.vertices[0], t.vertices[1]);
  return triangles;
}

}  // namespace hwsim::oracle
