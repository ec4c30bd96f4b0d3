// A stand-in for the Metal scene of the AGAA paper: chairs, baskets, wheels, springs and railings of thin,
// strongly curved rods, and nothing behind them.
#include <algorithm>
#include <cmath>

#include "pipeline/generate/ironwork.h"
#include "pipeline/generate/registry.h"

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec3;

enum LookIndex { kSteel, kBrass, kBlackSteel, kRubber };

// A shell woven of rods along both directions of point(u, v).
template <class Point>
void add_woven_shell(MeshSurface& s, int rods_u, int rods_v, double radius, int sides, int segments,
                     Point point) {
  for (int direction = 0; direction < 2; ++direction) {
    const int rods = direction == 0 ? rods_u : rods_v;
    for (int rod = 0; rod <= rods; ++rod) {
      const double fixed = static_cast<double>(rod) / rods;
      std::vector<dvec3> path;
      for (int i = 0; i <= segments; ++i) {
        const double t = static_cast<double>(i) / segments;
        path.push_back(direction == 0 ? point(fixed, t) : point(t, fixed));
      }
      add_tube(s, path, rod == 0 || rod == rods ? 1.6 * radius : radius, sides, true);
    }
  }
}

struct Rods {
  double radius;
  int sides, segments, weave;
};

Model wire_chair(const Rods& rods, int look) {
  Model out{"wire chair", {{MeshSurface{}, look}}};
  MeshSurface& s = out.pieces[0].surface;
  // The seat curves up into the back; edges bend outward.
  add_woven_shell(s, rods.weave, rods.weave, rods.radius, rods.sides, rods.segments, [](double u, double v) {
    const double x = (u - 0.5) * (0.62 - 0.12 * v), edge = (2 * u - 1) * (2 * u - 1);
    const double angle = std::max(0.0, v - 0.4) / 0.6 * 1.35;
    const double run = std::min(v, 0.4) * 0.9 + 0.4 * exact_sin(angle),
                 rise = 0.55 * (1.0 - exact_cos(angle));
    return dvec3(x,
                 0.44 + rise * 1.05 + 0.09 * edge * (1 - v) -
                     0.04 * (1 - edge) * exact_sin(kPi * std::min(v / 0.6, 1.0)),
                 0.36 - run + 0.08 * edge * v);
  });
  for (const double side : {-1.0, 1.0}) {
    const double x = side * 0.2;
    add_tube(s, {{x * 1.3, 0, 0.3}, {x, 0.38, 0.2}, {x, 0.41, 0}, {x, 0.38, -0.1}, {x * 1.3, 0, -0.25}},
             2.2 * rods.radius, rods.sides, true);
    add_tube(s, {{x * 1.3, 0.006, 0.3}, {x * 1.3, 0.006, -0.25}}, 2.2 * rods.radius, rods.sides, true);
  }
  return out;
}

Model basket(const Rods& rods, int look) {
  Model out{"basket", {{MeshSurface{}, look}}};
  MeshSurface& s = out.pieces[0].surface;
  const auto radius_at = [](double y) { return 0.2 + 0.1 * exact_sin(1.9 * y / 0.42); };
  for (int i = 0; i <= rods.weave; ++i) {
    const double y = 0.42 * i / rods.weave;
    add_ring(s, {0, y, 0}, {1, 0, 0}, {0, 0, -1}, radius_at(y),
             i == rods.weave ? 2 * rods.radius : rods.radius, 3 * rods.segments, rods.sides);
  }
  for (int i = 0; i < 3 * rods.weave; ++i) {
    const double turn = 2 * kPi * i / (3 * rods.weave);
    std::vector<dvec3> path;
    for (int k = 0; k <= rods.segments; ++k) {
      const double y = 0.42 * k / rods.segments;
      path.emplace_back(radius_at(y) * exact_cos(turn), y, radius_at(y) * exact_sin(turn));
    }
    add_tube(s, path, rods.radius, rods.sides, true);
  }
  return out;
}

Model spring(const Rods& rods, int look, double turns) {
  Model out{"spring", {{MeshSurface{}, look}}};
  std::vector<dvec3> path;
  const int steps = static_cast<int>(turns * rods.segments);
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps, angle = 2 * kPi * turns * t;
    path.emplace_back(0.09 * exact_cos(angle), 0.6 * t + 0.01, 0.09 * exact_sin(angle));
  }
  add_tube(out.pieces[0].surface, path, 1.6 * rods.radius, rods.sides, true);
  return out;
}

Blueprint make(const Parameters& p) {
  Pcg random(p.seed());
  const Rods rods{p.number("radius_m"), p.count("sides"), p.count("segments"), p.count("weave")};
  Blueprint out;
  const double roughness = p.number("roughness");
  out.looks = {{.name = "steel", .color = {0.75, 0.76, 0.78}, .metallic = 0.8, .roughness = roughness},
               {.name = "brass", .color = {0.8, 0.6, 0.25}, .metallic = 0.8, .roughness = roughness},
               {.name = "black steel", .color = {0.12, 0.12, 0.13}, .metallic = 0.5, .roughness = roughness},
               {.name = "rubber", .color = {0.04, 0.04, 0.04}, .roughness = 0.9}};
  out.models = {wire_chair(rods, kSteel), wire_chair(rods, kBlackSteel), basket(rods, kSteel),
                basket(rods, kBrass),     spring(rods, kSteel, 12.0),    spring(rods, kBrass, 7.0)};
  Model wheel{"wheel", {{MeshSurface{}, kSteel}, {MeshSurface{}, kRubber}}};
  add_spoked_wheel(wheel.pieces[0].surface, wheel.pieces[1].surface, {0, 0.33, 0}, {1, 0, 0}, {0, 1, 0}, 0.32,
                   4 * rods.weave, rods.sides);
  Model railing{"railing", {{MeshSurface{}, kBlackSteel}}};
  add_railing(railing.pieces[0].surface, {-1.0, 0, 0}, {1.0, 0, 0},
              {1.0, 9.0, 2 * rods.radius, rods.sides, true, true});
  out.models.push_back(std::move(wheel));
  out.models.push_back(std::move(railing));
  const int kinds = static_cast<int>(out.models.size());
  // Rows that recede; what stands in a row is drawn by lot, each kind equally often.
  const int pieces = p.count("pieces");
  for (int i = 0; i < pieces; ++i) {
    const int row = i / 5, kind = (i * 5 + random.below(3)) % kinds;
    const double depth = -1.3 * row, x = (i % 5 - 2) * (0.85 + 0.12 * row) + random.uniform(-0.15, 0.15);
    out.placements.push_back({kind, {x, 0, depth + random.uniform(-0.3, 0.3)}, random.uniform(-1.2, 1.2)});
  }
  out.eye = {0.4, 1.5, 2.7};
  out.target = {0.0, 0.42, -1.2};
  out.fov_y_rad = 0.85;
  out.near_m = 0.05;
  return out;
}

}  // namespace

Generator metal() {
  return {{"metal",
           "chairs, baskets, wheels, springs and railings of thin curved metal rods",
           {{"pieces", 25, 1, 10000, "number of things, five in a row"},
            {"weave", 16, 2, 100, "rods across a chair or a basket"},
            {"radius_m", 0.0035, 0.0002, 0.1, "radius of a rod in meters"},
            {"sides", 8, 3, 64, "sides of a rod's cross-section"},
            {"segments", 24, 3, 500, "segments along a rod"},
            {"roughness", 0.3, 0.05, 1, "roughness of the metal; 0.3 is a Phong exponent of 245"},
            seed_parameter()}},
          make};
}

}  // namespace hwsim::pipeline::generate
