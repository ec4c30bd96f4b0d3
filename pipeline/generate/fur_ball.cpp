// A stand-in for the Fur Ball of the AGAA paper: a ball under dense fur, each hair a strip far thinner than a
// pixel. The default gives up to about 32 triangles in a pixel at 1280x720.
#include <cmath>

#include "pipeline/generate/plants.h"
#include "pipeline/generate/registry.h"

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec3;

constexpr double kBallRadius = 0.7;

struct Fur {
  double length_m, width_m;
  int segments;
  dvec3 wave[3], phase;
};

// Neighboring hairs lean the same way: a smooth field over the ball.
dvec3 comb(const Fur& fur, const dvec3& n) {
  dvec3 way(0.0);
  for (int i = 0; i < 3; ++i) way[i] = exact_sin(glm::dot(fur.wave[i], n) + fur.phase[i]);
  return way;
}

void add_hair(MeshSurface& s, Pcg& random, const Fur& fur) {
  const dvec3 n = random_direction(random);
  const dvec3 lean = comb(fur, n) * 0.5 + random_direction(random) * 0.3 + dvec3(0, -0.35, 0);
  const double length = fur.length_m * random.uniform(0.6, 1.0), curl = random.uniform(0.02, 0.05) * length;
  const double turn = random.uniform(0.0, 2 * kPi);
  const dvec3 side = unit(glm::cross(n, random_direction(random))), other = glm::cross(n, side);
  std::vector<dvec3> path;
  for (int i = 0; i <= fur.segments; ++i) {
    const double t = static_cast<double>(i) / fur.segments, angle = turn + 9.0 * t;
    path.push_back(n * (kBallRadius + length * t) + lean * (length * t * t) +
                   (side * exact_cos(angle) + other * exact_sin(angle)) * (curl * t));
  }
  const auto base = static_cast<std::uint32_t>(s.positions.size());
  const auto last = static_cast<std::uint32_t>(fur.segments);
  for (std::uint32_t i = 0; i <= last; ++i) {
    const dvec3 along = unit(path[i < last ? i + 1 : i] - path[i > 0 ? i - 1 : i]);
    // A strip has the normal of a thin cylinder's outer side, and lies square to it.
    const dvec3 normal = unit(n - along * glm::dot(n, along)), across = glm::cross(along, normal);
    const double half = 0.5 * fur.width_m * (1.0 - static_cast<double>(i) / last);
    for (const double sign : {-1.0, 1.0}) {
      if (i == last && sign > 0) continue;  // ends in a point
      s.positions.emplace_back(path[i] + across * (sign * half));
      s.normals.emplace_back(normal);
      s.uvs.emplace_back(0.5f + 0.5f * static_cast<float>(sign), static_cast<float>(i));
    }
  }
  for (std::uint32_t i = 0; i < last; ++i) {
    const std::uint32_t a = base + 2 * i;
    s.indices.insert(s.indices.end(), {a, a + 1, a + 2});
    if (i + 1 < last) s.indices.insert(s.indices.end(), {a + 1, a + 3, a + 2});
  }
}

Blueprint make(const Parameters& p) {
  Pcg random(p.seed());
  Fur fur;
  fur.length_m = p.number("length_m");
  fur.width_m = p.number("width_m");
  fur.segments = p.count("segments");
  for (dvec3& wave : fur.wave) {  // two draws in one expression would come in the compiler's order
    const double frequency = random.uniform(3.0, 6.0);
    wave = random_direction(random) * frequency;
  }
  for (int i = 0; i < 3; ++i) fur.phase[i] = random.uniform(0.0, 2 * kPi);
  Blueprint out;
  out.looks = {{.name = "skin", .color = {0.25, 0.16, 0.1}, .roughness = 0.9}};
  const dvec3 colors[] = {{0.62, 0.42, 0.22}, {0.5, 0.3, 0.14}, {0.75, 0.58, 0.36}};
  for (int i = 0; i < 3; ++i)
    out.looks.push_back(
        {.name = "hair " + std::to_string(i), .color = colors[i], .roughness = 0.45, .double_sided = true});
  Model ball{"fur ball", {{MeshSurface{}, 0}, {MeshSurface{}, 1}, {MeshSurface{}, 2}, {MeshSurface{}, 3}}};
  add_grid(ball.pieces[0].surface, 96, 48, true, false, [](double u, double v) {
    const double turn = -2 * kPi * u, rise = kPi * (v - 0.5);
    return dvec3(exact_cos(turn) * exact_cos(rise), exact_sin(rise), exact_sin(turn) * exact_cos(rise)) *
           kBallRadius;
  });
  for (int i = 0; i < p.count("hairs"); ++i)
    add_hair(ball.pieces[static_cast<std::size_t>(1 + random.below(3))].surface, random, fur);
  out.models.push_back(std::move(ball));
  out.placements.push_back({});
  out.eye = {0.0, 0.95, 4.9};
  out.target = {0.0, -0.04, 0.0};
  out.fov_y_rad = 0.7;
  return out;
}

}  // namespace

Generator fur_ball() {
  return {{"fur_ball",
           "ball under dense fur: up to about 32 triangles in a pixel at 1280x720",
           {{"hairs", 120000, 1, 2000000, "number of hairs"},
            {"segments", 6, 1, 64, "segments of a hair, two triangles each but one at the tip"},
            {"length_m", 0.4, 0.001, 2, "length of the longest hair in meters"},
            {"width_m", 0.0018, 0.0001, 0.1, "width of a hair at its root in meters"},
            seed_parameter()}},
          make};
}

}  // namespace hwsim::pipeline::generate
