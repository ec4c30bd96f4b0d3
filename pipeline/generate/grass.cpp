// A field of blades, each one triangle or a short bent strip. The defaults hold the share of complex pixels
// of SBAA's GRASS (Table 3, 8x); its 4x entry disagrees with its 8x entry and is left aside.
#include <algorithm>
#include <cmath>

#include "pipeline/generate/exact_math.h"
#include "pipeline/generate/registry.h"

namespace hwsim::pipeline::generate {
namespace {

struct Blade {
  glm::dvec3 foot, across, lean;
  double height = 0.0, half_width = 0.0;
};

Blade random_blade(Pcg& random, double side, double height, double width_ratio) {
  const double angle = random.uniform(0.0, 2.0 * kPi), lean_angle = random.uniform(0.0, 2.0 * kPi);
  Blade blade;
  blade.foot = {random.uniform(-side / 2, side / 2), 0.0, random.uniform(-side / 2, side / 2)};
  blade.height = height * random.uniform(0.5, 1.0);
  blade.half_width = blade.height * 0.5 * width_ratio * random.uniform(0.67, 1.33);
  blade.across = {exact_cos(angle), 0.0, exact_sin(angle)};
  blade.lean = glm::dvec3(exact_cos(lean_angle), 0.0, exact_sin(lean_angle)) *
               (blade.height * random.uniform(0.1, 0.6));
  return blade;
}

glm::dvec3 spine(const Blade& b, double t) {
  return b.foot + glm::dvec3(0, b.height * t, 0) + b.lean * (t * t);
}

void add_blade(MeshSurface& s, const Blade& b, int segments) {
  const auto edge = [&](int i, double sign) {
    const double t = static_cast<double>(i) / segments;
    return spine(b, t) + b.across * (sign * b.half_width * (1.0 - t));
  };
  for (int i = 0; i + 1 < segments; ++i)
    add_quad(s, edge(i, -1), edge(i, 1), edge(i + 1, 1), edge(i + 1, -1));
  add_triangle(s, edge(segments - 1, -1), edge(segments - 1, 1), spine(b, 1.0));
}

Blueprint make(const Parameters& p) {
  Pcg random(p.seed());
  const double side = p.number("side_m");
  Blueprint out;
  out.looks = {{.name = "soil", .color = {0.12, 0.08, 0.05}, .roughness = 1.0}};
  for (int shade = 0; shade < 3; ++shade)
    out.looks.push_back({.name = "blade " + std::to_string(shade),
                         .color = {0.1 + 0.06 * shade, 0.35 + 0.08 * shade, 0.05},
                         .roughness = 0.6,
                         .double_sided = true});
  Model field{"field", {{MeshSurface{}, 0}, {MeshSurface{}, 1}, {MeshSurface{}, 2}, {MeshSurface{}, 3}}};
  add_panel(field.pieces[0].surface, {-side / 2, 0, side / 2}, {side, 0, 0}, {0, 0, -side}, 16, 16);
  for (int i = 0; i < p.count("blades"); ++i) {
    const Blade blade = random_blade(random, side, p.number("height_m"), p.number("width_ratio"));
    add_blade(field.pieces[static_cast<std::size_t>(1 + random.below(3))].surface, blade,
              p.count("segments"));
  }
  out.models.push_back(std::move(field));
  out.placements.push_back({});
  out.eye = {0.0, 0.9 + 0.02 * side, 0.5 * side};
  out.target = {0.0, 0.1, 0.0};
  out.fov_y_rad = p.fov_y_rad();
  return out;
}

}  // namespace

Generator grass() {
  return {{"grass",
           "field of grass blades, one triangle each unless bent",
           {{"blades", 12000, 1, 2000000, "number of blades"},
            {"side_m", 6, 0.5, 1000, "side of the square field in meters"},
            {"height_m", 0.45, 0.01, 10, "height of the tallest blade in meters"},
            {"width_ratio", 0.25, 0.001, 1, "width of a blade at its foot over its height"},
            {"segments", 1, 1, 8, "segments of a blade; 1 is a single triangle"},
            fov_parameter(17),
            seed_parameter()}},
          make};
}

}  // namespace hwsim::pipeline::generate
