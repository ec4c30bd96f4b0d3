// Power poles with sagging wires. The wires carry _HWSIM_RADIUS: their vertices lie on the center line (see
// Mesh::radius).
#include <cmath>

#include "pipeline/generate/exact_math.h"
#include "pipeline/generate/registry.h"

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec3;

constexpr double kPoleHeight = 8.0, kCrossarmHalf = 1.2;

void add_pole(Model& model) {
  MeshSurface& wood = model.pieces[0].surface;
  add_tube(wood, {{0, 0, 0}, {0, kPoleHeight + 0.4, 0}}, 0.13, 16, true);
  for (const double height : {kPoleHeight, kPoleHeight - 1.0})
    add_box(wood, {-kCrossarmHalf, height - 0.06, -0.06}, {kCrossarmHalf, height + 0.06, 0.06});
  for (const double height : {kPoleHeight, kPoleHeight - 1.0})
    for (int i = 0; i < 4; ++i)
      add_lathe(model.pieces[1].surface,
                {-kCrossarmHalf + 0.1 + i * (2 * kCrossarmHalf - 0.2) / 3, height + 0.06, 0},
                {{0.05, 0.0}, {0.02, 0.03}, {0.05, 0.06}, {0.02, 0.09}, {0.04, 0.12}, {0.0, 0.14}}, 10);
}

// A parabola, which a taut catenary is to second order.
std::vector<dvec3> span_path(const dvec3& from, const dvec3& to, double sag, int segments) {
  std::vector<dvec3> path;
  for (int i = 0; i <= segments; ++i) {
    const double t = static_cast<double>(i) / segments;
    path.push_back(from + (to - from) * t - dvec3(0, 4.0 * sag * t * (1.0 - t), 0));
  }
  return path;
}

Blueprint make(const Parameters& p) {
  Pcg random(p.seed());
  const int poles = p.count("poles"), lines = p.count("wires");
  const double spacing = p.number("spacing_m");
  Blueprint out;
  out.looks = {{.name = "wood", .color = {0.28, 0.2, 0.13}},
               {.name = "ceramic", .color = {0.5, 0.45, 0.4}, .roughness = 0.3},
               {.name = "wire", .color = {0.7, 0.7, 0.72}, .roughness = 0.5},  // weathered aluminum
               {.name = "ground", .color = {0.2, 0.26, 0.12}, .roughness = 1.0}};
  Model pole{"pole", {{MeshSurface{}, 0}, {MeshSurface{}, 1}}};
  add_pole(pole);
  Model ground{"ground", {{MeshSurface{}, 3}}};
  const double length = spacing * poles + 40.0;
  add_panel(ground.pieces[0].surface, {-40, 0, 20}, {80, 0, 0}, {0, 0, -length}, 20, 40);
  Model cables{"wires", {{MeshSurface{}, 2}}};
  for (int i = 0; i + 1 < poles; ++i)
    for (int line = 0; line < lines; ++line) {
      const double x = lines > 1
                           ? -kCrossarmHalf + 0.1 +
                                 (line / 2) * (2 * kCrossarmHalf - 0.2) / ((lines - 1) / 2 + (lines <= 2))
                           : 0.0;
      const double y = kPoleHeight + 0.2 - (line % 2);
      add_wire(cables.pieces[0].surface,
               span_path({x, y, -spacing * i}, {x, y, -spacing * (i + 1)},
                         p.number("sag_m") * random.uniform(0.8, 1.2), p.count("segments")),
               p.number("radius_m"), p.count("sides"));
    }
  out.models = {pole, ground, cables};
  for (int i = 0; i < poles; ++i) out.placements.push_back({0, {0, 0, -spacing * i}, 0.0});
  out.placements.push_back({1, {}, 0.0});
  if (poles > 1) out.placements.push_back({2, {}, 0.0});
  out.eye = {3.2, 1.7, 9.0};
  out.target = {0.0, 6.0, -1.5 * spacing};
  // From the side, and strong: a wire has a side brighter than the sky and a dark one, so that its lighting
  // can be seen.
  out.sun_direction = {0.8, -0.45, -0.3};
  out.sun_lux = 4.0;
  return out;
}

}  // namespace

Generator wires() {
  return {{"wires",
           "power poles with sagging wires that carry a radius, for wire anti-aliasing",
           {{"poles", 8, 1, 1000, "number of poles"},
            {"wires", 8, 1, 64, "wires between two poles"},
            {"spacing_m", 25, 1, 500, "distance of two poles in meters"},
            {"sag_m", 0.9, 0, 5, "sag of a wire in its middle in meters"},
            {"radius_m", 0.008, 0.0001, 1, "radius of a wire in meters"},
            {"segments", 24, 1, 1000, "segments of a wire between two poles"},
            {"sides", 6, 3, 64, "sides of a wire's cross-section"},
            seed_parameter()}},
          make};
}

}  // namespace hwsim::pipeline::generate
