#include "pipeline/generate/ironwork.h"

#include <algorithm>
#include <cmath>

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec2;
using glm::dvec3;

double length_of(const dvec3& v) { return std::sqrt(glm::dot(v, v)); }

// A quadratic Bezier curve: bent bars.
std::vector<dvec3> bent(const dvec3& a, const dvec3& b, const dvec3& c, int segments) {
  std::vector<dvec3> path;
  for (int i = 0; i <= segments; ++i) {
    const double t = static_cast<double>(i) / segments;
    path.push_back(a * ((1 - t) * (1 - t)) + b * (2 * t * (1 - t)) + c * (t * t));
  }
  return path;
}

}  // namespace

void add_ring(MeshSurface& s, const dvec3& center, const dvec3& x, const dvec3& y, double radius,
              double wire_radius, int segments, int sides) {
  const dvec3 axis = glm::cross(x, y);
  add_grid(s, sides, segments, true, true, [&](double u, double v) {
    const dvec3 out = x * exact_cos(2 * kPi * v) + y * exact_sin(2 * kPi * v);
    const double angle = 2 * kPi * u;
    return center + out * (radius + wire_radius * exact_cos(angle)) - axis * (wire_radius * exact_sin(angle));
  });
}

void add_scroll(MeshSurface& s, const dvec3& foot, const dvec3& x, const dvec3& y, double size,
                double wire_radius, int segments, int sides) {
  // r = a (1 - t)^1.2 over one turn and a half.
  std::vector<dvec3> path;
  const dvec3 center = foot + x * (0.5 * size);
  for (int i = 0; i <= segments; ++i) {
    const double t = static_cast<double>(i) / segments, angle = 3.0 * kPi * t;
    const double r = 0.5 * size * (1.0 - 0.85 * t);
    path.push_back(center - x * (r * exact_cos(angle)) + y * (r * exact_sin(angle)));
  }
  add_tube(s, path, wire_radius, sides, true);
}

void add_railing(MeshSurface& s, const dvec3& from, const dvec3& to, const RailingShape& shape) {
  const double length = length_of(to - from);
  const dvec3 along = (to - from) / length, up(0, 1, 0);
  const int bars = std::max(1, static_cast<int>(length * shape.bars_per_m));
  const double pitch = length / bars, h = shape.height_m, r = shape.bar_radius_m;
  for (const double y : {0.08 * h, 0.8 * h, h})
    add_tube(s, {from + up * y, to + up * y}, r * (y == h ? 2.0 : 1.4), shape.sides, true);
  for (int i = 0; i <= bars; ++i) {
    const dvec3 foot = from + along * (pitch * i);
    add_tube(s, {foot, foot + up * h}, r, shape.sides, false);
    if (shape.spears) add_lathe(s, foot + up * h, {{r, 0}, {2.6 * r, 4 * r}, {0.0, 14 * r}}, shape.sides);
    if (!shape.scrolls || i == bars) continue;
    const dvec3 middle = foot + along * (0.5 * pitch);
    add_ring(s, middle + up * (0.9 * h), along, up, 0.8 * std::min(0.1 * h, 0.5 * pitch), 0.6 * r, 10,
             std::max(3, shape.sides - 2));
    for (const double side : {-1.0, 1.0})
      add_scroll(s, middle + up * (0.3 * h), along * side, up, 0.45 * pitch, 0.6 * r, 12,
                 std::max(3, shape.sides - 2));
  }
}

void add_chair(MeshSurface& iron, MeshSurface& seat, double bar_radius_m, int sides) {
  constexpr double kHalf = 0.2, kSeat = 0.46, kBack = 0.88;
  for (const double x : {-kHalf, kHalf}) {
    add_tube(iron, bent({x * 1.12, 0, kHalf * 1.15}, {x, 0.3, kHalf}, {x, kSeat, kHalf}, 6), bar_radius_m,
             sides, true);
    add_tube(iron,
             bent({x * 1.12, 0, -kHalf * 1.3}, {x, kSeat, -kHalf}, {x * 0.95, kBack, -kHalf * 1.35}, 10),
             bar_radius_m, sides, true);
    add_tube(iron, {{x, kSeat, -kHalf * 0.98}, {x, kSeat, kHalf}}, bar_radius_m, sides, true);
    // An arm that leaves the back and comes down to the seat.
    add_tube(iron, bent({x, 0.68, -kHalf * 1.1}, {x * 1.2, 0.72, kHalf}, {x, kSeat, kHalf}, 10), bar_radius_m,
             sides, true);
  }
  const double back_z = -kHalf * 1.28;
  add_tube(iron, bent({-kHalf, kBack, back_z}, {0, kBack + 0.1, back_z}, {kHalf, kBack, back_z}, 8),
           bar_radius_m, sides, true);
  for (int i = -2; i <= 2; ++i)
    add_tube(iron, {{0.07 * i, kSeat, -kHalf}, {0.07 * i, kBack + 0.03, back_z}}, 0.5 * bar_radius_m, sides,
             false);
  add_ring(iron, {0, 0.7, -kHalf * 1.15}, {1, 0, 0}, {0, 1, 0}, 0.07, 0.6 * bar_radius_m, 20, sides);
  for (int i = 0; i < 9; ++i) {
    const double z = -kHalf + 2 * kHalf * (i + 0.12) / 9;
    add_box(seat, {-kHalf - 0.015, kSeat, z}, {kHalf + 0.015, kSeat + 0.014, z + 2 * kHalf * 0.76 / 9});
  }
}

void add_table(MeshSurface& iron, MeshSurface& top, double radius_m, int sides) {
  constexpr double kHeight = 0.73;
  const int around = 6 * sides;
  add_lathe(top, {0, kHeight, 0}, {{0.0, 0.0}, {radius_m, 0.0}}, around);
  add_lathe(top, {0, kHeight, 0}, {{radius_m, 0.0}, {radius_m, 0.022}}, around);
  add_lathe(top, {0, kHeight, 0}, {{radius_m, 0.022}, {0.0, 0.022}}, around);
  add_ring(iron, {0, kHeight + 0.011, 0}, {1, 0, 0}, {0, 0, 1}, radius_m + 0.004, 0.008, around, sides);
  add_tube(iron, {{0, 0.2, 0}, {0, kHeight, 0}}, 0.025, 2 * sides, false);
  for (int i = 0; i < 3; ++i) {
    const double turn = 2 * kPi * i / 3;
    const dvec3 out(exact_cos(turn), 0, exact_sin(turn));
    add_tube(iron, bent(dvec3(0, 0.3, 0), out * 0.1 + dvec3(0, 0.15, 0), out * (0.75 * radius_m), 8), 0.014,
             sides, true);
    add_scroll(iron, dvec3(0, 0.45, 0), out, {0, 1, 0}, 0.14, 0.006, 14, sides);
  }
}

void add_spoked_wheel(MeshSurface& iron, MeshSurface& tire, const dvec3& center, const dvec3& x,
                      const dvec3& y, double radius_m, int spokes, int sides) {
  const dvec3 axis = glm::cross(x, y);
  const int around = std::max(24, 8 * sides);
  add_ring(tire, center, x, y, radius_m, 0.014, around, sides);
  add_ring(iron, center, x, y, radius_m - 0.02, 0.007, around, sides);
  add_tube(iron, {center - axis * 0.03, center + axis * 0.03}, 0.018, 2 * sides, true);
  for (int i = 0; i < spokes; ++i) {
    // Spokes leave the hub on alternating sides, as tangents.
    const double rim = 2 * kPi * i / spokes, hub = rim + (i % 4 < 2 ? 1.2 : -1.2);
    const double side = i % 2 == 0 ? 0.025 : -0.025;
    add_tube(iron,
             {center + (x * exact_cos(hub) + y * exact_sin(hub)) * 0.017 + axis * side,
              center + (x * exact_cos(rim) + y * exact_sin(rim)) * (radius_m - 0.02)},
             0.0018, std::max(3, sides - 2), false);
  }
}

}  // namespace hwsim::pipeline::generate
