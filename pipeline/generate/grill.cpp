// A stand-in for the truck's radiator grill in SSS (Siegl et al. 2013, Fig. 8): round chrome bars, each with
// a thin highlight along it.
#include <algorithm>
#include <cmath>

#include "pipeline/generate/ironwork.h"
#include "pipeline/generate/registry.h"

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec3;

constexpr double kHalfWidth = 0.62, kLow = 0.75, kHigh = 1.85, kCorner = 0.12;
enum LookIndex { kPaint, kChrome, kDark, kLamp, kMesh };

// A closed rectangle with round corners in the plane z = `z`, `grow` outside the opening.
std::vector<dvec3> rounded_frame(double grow, double z, int corner_steps) {
  const double x = kHalfWidth + grow, low = kLow - grow, high = kHigh + grow, r = kCorner + grow;
  const dvec3 centers[] = {
      {x - r, high - r, z}, {r - x, high - r, z}, {r - x, low + r, z}, {x - r, low + r, z}};
  std::vector<dvec3> path;
  for (int corner = 0; corner < 4; ++corner)
    for (int i = 0; i <= corner_steps; ++i) {
      const double angle = 0.5 * kPi * (corner + static_cast<double>(i) / corner_steps);
      path.push_back(centers[corner] + dvec3(r * exact_cos(angle), r * exact_sin(angle), 0));
    }
  return path;
}

// Bands between frames that grow outward: the painted hood around the opening.
void add_surround(MeshSurface& paint, int detail) {
  const int steps = 2 * detail;
  constexpr double kGrow[] = {0.0, 0.012, 0.035, 0.08, 0.16, 0.22, 0.25, 0.26, 0.262};
  constexpr double kDepth[] = {-0.06, 0.01, 0.035, 0.045, 0.035, 0.0, -0.08, -0.25, -0.8};
  const auto columns = static_cast<int>(rounded_frame(0, 0, steps).size());
  const int bands = 4 * detail;
  std::vector<std::vector<dvec3>> rows;
  for (int i = 0; i <= bands; ++i) {
    const double t = 8.0 * i / bands;
    const int k = std::min(static_cast<int>(t), 7);
    const double f = t - k, smooth = f * f * (3 - 2 * f);
    rows.push_back(rounded_frame(kGrow[k] + (kGrow[k + 1] - kGrow[k]) * f,
                                 kDepth[k] + (kDepth[k + 1] - kDepth[k]) * smooth, steps));
  }
  add_grid(paint, columns, bands, true, false, [&](double u, double v) {
    const auto column =
        static_cast<std::size_t>((1.0 - u) * columns + 0.5) % static_cast<std::size_t>(columns);
    return rows[static_cast<std::size_t>(v * bands + 0.5)][column];
  });
}

// The front bows forward toward its middle.
double bow(double x) { return 0.03 * (1.0 - x * x / (kHalfWidth * kHalfWidth)); }

void add_bars(MeshSurface& chrome, const Parameters& p) {
  const int bars = p.count("bars"), sides = p.count("sides"), segments = p.count("segments");
  const double radius = p.number("radius_m"), middle = 0.5 * (kLow + kHigh), half = 0.5 * (kHigh - kLow);
  for (int i = 0; i < bars; ++i) {
    const double y = middle + half * (2.0 * (i + 0.5) / bars - 1.0);
    // Bars near the ends stop at the round corners.
    const double into = std::max(0.0, std::abs(y - middle) - (half - kCorner));
    const double reach = kHalfWidth - kCorner + std::sqrt(std::max(0.0, kCorner * kCorner - into * into));
    std::vector<dvec3> path;
    for (int k = 0; k <= segments; ++k) {
      const double x = reach * (2.0 * k / segments - 1.0);
      path.emplace_back(x, y, bow(x));
    }
    add_tube(chrome, path, radius, sides, false);
  }
  for (int i = -1; i <= 1; ++i) {
    const double x = 0.5 * kHalfWidth * i;
    add_tube(chrome, {{x, kLow, bow(x) - 0.02}, {x, kHigh, bow(x) - 0.02}}, 1.3 * radius, sides, false);
  }
}

// A painted fender with round edges: |x|^4 + |y|^4 + |z|^4 = 1, from a sphere's directions.
void add_fender(MeshSurface& paint, const dvec3& center, const dvec3& half, int detail) {
  add_grid(paint, 12 * detail, 8 * detail, true, false, [&](double u, double v) {
    const double turn = -2 * kPi * u, rise = kPi * (v - 0.5);
    const dvec3 n(exact_cos(turn) * exact_cos(rise), exact_sin(rise), exact_sin(turn) * exact_cos(rise));
    const dvec3 square = n * n;
    return center + half * n / std::sqrt(std::sqrt(glm::dot(square, square)));
  });
}

void add_mesh(MeshSurface& mesh, double pitch) {
  for (double x = -kHalfWidth; x <= kHalfWidth; x += pitch)
    add_tube(mesh, {{x, kLow, -0.075}, {x, kHigh, -0.075}}, 0.0015, 4, false);
  for (double y = kLow; y <= kHigh; y += pitch)
    add_tube(mesh, {{-kHalfWidth, y, -0.078}, {kHalfWidth, y, -0.078}}, 0.0015, 4, false);
}

void add_lamp(Model& truck, const dvec3& at, int detail) {
  MeshSurface &chrome = truck.pieces[kChrome].surface, &lens = truck.pieces[kLamp].surface;
  add_ring(chrome, at, {1, 0, 0}, {0, 1, 0}, 0.105, 0.014, 12 * detail, 2 * detail);
  add_grid(lens, 12 * detail, 3 * detail, true, false, [&](double u, double v) {
    const double turn = 2 * kPi * u, r = 0.1 * (1.0 - v);
    return at + dvec3(r * exact_cos(turn), r * exact_sin(turn), 0.035 * (1.0 - r * r / 0.01));
  });
  add_grid(chrome, 12 * detail, 3 * detail, true, false, [&](double u, double v) {  // the pot behind
    const double turn = 2 * kPi * u, r = 0.115 * exact_sin(0.5 * kPi * v + 0.001);
    return at + dvec3(r * exact_cos(turn), r * exact_sin(turn), -0.16 * exact_cos(0.5 * kPi * v));
  });
}

Blueprint make(const Parameters& p) {
  Pcg random(p.seed());
  const int detail = p.count("detail");
  const double roughness = p.number("roughness");
  const dvec3 colors[] = {{0.03, 0.06, 0.3}, {0.4, 0.03, 0.03}, {0.05, 0.2, 0.08}, {0.35, 0.36, 0.38}};
  Blueprint out;
  out.looks = {
      {.name = "paint", .color = colors[(p.seed() + 3) % 4], .metallic = 0.3, .roughness = roughness},
      {.name = "chrome", .color = {0.8, 0.81, 0.83}, .metallic = 0.9, .roughness = roughness},
      {.name = "dark", .color = {0.015, 0.015, 0.015}, .roughness = 1.0},
      {.name = "lamp", .color = {0.75, 0.78, 0.8}, .metallic = 0.3, .roughness = 0.15},
      {.name = "mesh", .color = {0.1, 0.1, 0.1}, .metallic = 0.6, .roughness = 0.4}};
  Model truck{"truck", {}};
  for (int look = kPaint; look <= kMesh; ++look) truck.pieces.push_back({MeshSurface{}, look});
  MeshSurface& chrome = truck.pieces[kChrome].surface;
  add_surround(truck.pieces[kPaint].surface, detail);
  add_bars(chrome, p);
  std::vector<dvec3> frame = rounded_frame(0.012, 0.02, 3 * detail);
  frame.push_back(frame.front());
  add_tube(chrome, frame, 0.022, 3 * detail, false);
  add_mesh(truck.pieces[kMesh].surface, p.number("mesh_m"));
  add_panel(truck.pieces[kDark].surface, {-kHalfWidth - 0.05, kLow - 0.05, -0.2},
            {2 * kHalfWidth + 0.1, 0, 0}, {0, kHigh - kLow + 0.1, 0}, 4, 4);
  for (const double side : {-1.0, 1.0}) {
    add_fender(truck.pieces[kPaint].surface, {side * 1.2, 0.95, -0.62}, {0.36, 0.3, 0.5}, detail);
    for (const double x : {1.07, 1.34})
      add_lamp(truck, {side * x, 0.95 + random.uniform(-0.002, 0.002), -0.09}, detail);
  }
  std::vector<dvec3> bumper;
  for (int i = 0; i <= 16 * detail; ++i) {
    const double x = -1.5 + 3.0 * i / (16 * detail);
    bumper.emplace_back(x, 0.42, 0.12 - 0.1 * x * x);
  }
  add_tube(chrome, bumper, 0.13, 8 * detail, true);
  out.models.push_back(std::move(truck));
  out.placements.push_back({});
  out.eye = {0.9, 1.62, 2.0};
  out.target = {0.06, 1.24, 0.0};
  out.fov_y_rad = 0.66;
  out.more_views = {{"close_up", {0.35, 1.4, 1.1}, {0.0, 1.3, 0.0}, 0.6},
                    {"distant", {3.2, 2.6, 8.2}, {0.0, 1.1, 0.0}, 0.5}};
  out.sun_direction = {0.4, -0.8, -0.45};
  return out;
}

}  // namespace

Generator grill() {
  return {{"grill",
           "truck's radiator grill of round chrome bars; cameras suggested, close_up and distant",
           {{"bars", 60, 1, 2000, "level bars"},
            {"radius_m", 0.0075, 0.0005, 0.1, "radius of a bar in meters"},
            {"sides", 24, 3, 128, "sides of a bar's cross-section"},
            {"segments", 48, 1, 1000, "segments along a bar"},
            {"mesh_m", 0.012, 0.002, 1, "pitch of the wire mesh behind the bars in meters"},
            {"detail", 6, 2, 30, "segments of round parts"},
            {"roughness", 0.3, 0.05, 1, "roughness of paint and chrome; 0.3 is a Phong exponent of 245"},
            seed_parameter()}},
          make};
}

}  // namespace hwsim::pipeline::generate
