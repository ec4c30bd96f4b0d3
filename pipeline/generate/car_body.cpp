// A stand-in for the body of the BMW in SSS (Siegl et al. 2013): 500 k triangles in smooth curved panels,
// whose rolled edges and crease carry thin, long highlights.
#include <algorithm>
#include <cmath>

#include "pipeline/generate/ironwork.h"
#include "pipeline/generate/registry.h"
#include "pipeline/generate/spline_body.h"

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec3;

enum LookIndex { kPaint, kGlass, kChrome, kDark, kRubber, kLamp, kRedLamp };
constexpr double kTrack = 0.735;

std::vector<Panel> body_panels() {
  return {
      {0.0, 2.35, 0.0, 4.2, kPaint},                                 // rear bumper
      {2.4, 6.45, 0.9, 5.95, kPaint, Panel::Reach::arched_side},     // rear quarter
      {6.5, 9.05, 0.9, 5.95, kPaint, Panel::Reach::arched_side},     // rear door
      {9.1, 12.0, 0.9, 5.95, kPaint},                                // front door
      {12.05, 16.0, 0.9, 5.95, kPaint, Panel::Reach::arched_side},   // fender
      {16.05, 18.0, 0.0, 4.4, kPaint},                               // front bumper
      {5.6, 13.2, 0.0, 0.86, kPaint},                                // rocker
      {0.15, 2.35, 4.25, 5.95, kRedLamp},                            // tail lamp
      {16.05, 17.35, 4.45, 5.95, kLamp},                             // headlamp
      {0.0, 4.75, 6.0, 9.0, kPaint, Panel::Reach::whole_width},      // trunk lid
      {4.95, 7.0, 6.95, 9.0, kGlass, Panel::Reach::whole_width},     // rear window
      {7.05, 10.15, 6.95, 9.0, kPaint, Panel::Reach::whole_width},   // roof
      {10.2, 12.35, 6.95, 9.0, kGlass, Panel::Reach::whole_width},   // windshield
      {12.6, 17.35, 6.0, 9.0, kPaint, Panel::Reach::whole_width},    // hood
      {5.6, 7.0, 6.05, 6.9, kPaint},                                 // C pillar
      {7.05, 8.95, 6.05, 6.9, kGlass},                               // rear side window
      {9.1, 11.35, 6.05, 6.9, kGlass},                               // front side window
      {11.4, 12.4, 6.05, 6.9, kPaint},                               // mirror triangle
      {0.0, 18.0, 0.0, 9.0, kDark, Panel::Reach::arched_side, 0.02}  // behind the gaps
  };
}

void add_wheel(Model& wheel, int detail) {
  MeshSurface &rubber = wheel.pieces[0].surface, &rim = wheel.pieces[1].surface;
  const auto turned = [](MeshSurface& s, const std::vector<glm::dvec2>& profile, int around) {
    // (radius, z) about the z axis; outside lies to the right of the way along the profile.
    add_grid(s, around, static_cast<int>(profile.size()) - 1, true, false, [&](double u, double v) {
      const glm::dvec2 p =
          profile[static_cast<std::size_t>(v * static_cast<double>(profile.size() - 1) + 0.5)];
      return dvec3(p.x * exact_cos(2 * kPi * u), p.x * exact_sin(2 * kPi * u), p.y);
    });
  };
  std::vector<glm::dvec2> tire;
  for (int i = 0; i <= 2 * detail; ++i) {
    const double angle = kPi * (1.25 - 1.5 * i / (2 * detail));
    tire.push_back({0.27 + 0.046 * exact_sin(angle), 0.1 * exact_cos(angle)});
  }
  std::reverse(tire.begin(), tire.end());
  for (glm::dvec2& p : tire) p.y = -p.y;
  turned(rubber, tire, 10 * detail);
  turned(rim, {{0.21, -0.09}, {0.205, 0.05}, {0.212, 0.075}, {0.228, 0.085}, {0.24, 0.075}}, 10 * detail);
  turned(rim, {{0.06, 0.03}, {0.055, 0.07}, {0.03, 0.085}, {0.0, 0.088}}, 6 * detail);
  constexpr int kSpokes = 10;
  for (int i = 0; i < kSpokes; ++i) {
    const double angle = 2 * kPi * i / kSpokes;
    const dvec3 out(exact_cos(angle), exact_sin(angle), 0);
    std::vector<dvec3> path;
    for (int k = 0; k <= detail; ++k) {
      const double t = static_cast<double>(k) / detail;
      path.push_back(out * (0.045 + 0.17 * t) + dvec3(0, 0, 0.06 + 0.02 * t * (1 - t) * 4 - 0.01 * t));
    }
    add_tube(rim, path, 0.012, std::max(6, detail), false);
  }
}

// Kidneys, handles, mirrors, exhaust: what catches light beside the panels.
void add_trim(Model& car, int detail) {
  MeshSurface &chrome = car.pieces[kChrome].surface, &dark = car.pieces[kDark].surface;
  for (const double side : {-1.0, 1.0}) {
    const dvec3 middle(2.232, 0.56, side * 0.15);
    add_grid(chrome, std::max(6, detail), 6 * detail, true, true, [&](double u, double v) {
      const double a = 2 * kPi * v, b = 2 * kPi * u;
      const dvec3 out(0, exact_sin(a), exact_cos(a));
      const dvec3 ring(0, 0.075 * out.y, 0.115 * out.z);
      return middle + ring + out * (0.009 * exact_cos(b)) + dvec3(0.009 * exact_sin(b), 0, 0);
    });
    for (int i = -4; i <= 4; ++i) {
      const double z = 0.024 * i, h = 0.075 * std::sqrt(1.0 - z * z / (0.115 * 0.115));
      add_tube(chrome, {middle + dvec3(0.002, -h, z), middle + dvec3(0.002, h, z)}, 0.0045,
               std::max(6, detail), false);
    }
    for (const double s : {8.0, 10.2}) {  // door handles
      const dvec3 p = body_point(s, 5.0) * dvec3(1, 1, side);
      add_tube(chrome,
               {p + dvec3(-0.09, 0, side * 0.004), p + dvec3(-0.06, 0, side * 0.03),
                p + dvec3(0.06, 0, side * 0.03), p + dvec3(0.09, 0, side * 0.004)},
               0.011, std::max(6, detail), true);
    }
    const dvec3 mirror = body_point(11.45, 6.2) * dvec3(1, 1, side) + dvec3(0, 0.02, side * 0.12);
    MeshSurface& paint = car.pieces[kPaint].surface;
    add_grid(paint, 4 * detail, 2 * detail, true, false, [&](double u, double v) {
      const double turn = -2 * kPi * u, rise = kPi * (v - 0.5);
      return mirror + dvec3(0.07 * exact_cos(turn) * exact_cos(rise), 0.06 * exact_sin(rise),
                            0.11 * exact_sin(turn) * exact_cos(rise));
    });
  }
  add_tube(chrome, {{-2.1, 0.24, 0.45}, {-2.27, 0.24, 0.45}}, 0.035, 3 * detail, true);
  add_box(dark, {-2.0, 0.17, -0.7}, {2.0, 0.26, 0.7});
}

/// Mouldings along windows, flank and roof: a pixel of the distant view is 7 mm, a moulding 6 mm, and its
/// highlight a seventh of that, so that samples of a pixel hit or miss it. These are the bead chains of SSS,
/// figure 1.
void add_mouldings(Model& car, int detail) {
  constexpr double kRadius = 0.003;
  struct Line {
    int look;
    double s0, s1, c;
  };
  for (const Line& line :
       {Line{kChrome, 5.6, 12.4, 6.0}, Line{kPaint, 2.4, 16.0, 5.2}, Line{kPaint, 7.0, 12.4, 6.95}})
    for (const double side : {-1.0, 1.0}) {
      std::vector<dvec3> path;
      const int pieces = 24 * detail;
      for (int i = 0; i <= pieces; ++i)
        path.push_back(body_point(line.s0 + (line.s1 - line.s0) * i / pieces, line.c) * dvec3(1, 1, side));
      add_tube(car.pieces[static_cast<std::size_t>(line.look)].surface, path, kRadius, std::max(8, detail),
               true);
    }
}

Blueprint make(const Parameters& p) {
  Pcg random(p.seed());
  const double triangles = p.number("triangles");
  const dvec3 colors[] = {{0.32, 0.38, 0.46}, {0.42, 0.04, 0.04}, {0.05, 0.12, 0.3}, {0.5, 0.5, 0.5}};
  Blueprint out;
  out.looks = {
      {.name = "paint",
       .color = colors[(p.seed() + 3) % 4],
       .metallic = 0.5,
       .roughness = p.number("roughness")},
      {.name = "glass", .color = {0.03, 0.035, 0.04}, .roughness = 0.2},
      {.name = "chrome", .color = {0.8, 0.8, 0.82}, .metallic = 0.9, .roughness = p.number("roughness")},
      {.name = "dark", .color = {0.02, 0.02, 0.02}, .roughness = 0.9, .double_sided = true},
      {.name = "rubber", .color = {0.03, 0.03, 0.03}, .roughness = 0.8},
      {.name = "lamp", .color = {0.7, 0.72, 0.75}, .metallic = 0.4, .roughness = 0.2},
      {.name = "red lamp", .color = {0.5, 0.02, 0.02}, .roughness = 0.2}};
  Model car{"car", {}}, wheel{"wheel", {{MeshSurface{}, kRubber}, {MeshSurface{}, kChrome}}};
  for (int look = kPaint; look <= kRedLamp; ++look) car.pieces.push_back({MeshSurface{}, look});
  const int detail = std::clamp(static_cast<int>(std::sqrt(triangles) / 70.0), 3, 40);
  add_wheel(wheel, detail);
  add_trim(car, detail);
  if (p.number("mouldings") > 0.0) add_mouldings(car, detail);
  double used = 4.0 * static_cast<double>(wheel.pieces[0].surface.indices.size() +
                                          wheel.pieces[1].surface.indices.size());
  for (const Piece& piece : car.pieces) used += static_cast<double>(piece.surface.indices.size());
  const std::vector<Panel> panels = body_panels();
  double area = 0.0;  // what lies behind the gaps gets a tenth of the density
  const auto weight = [](const Panel& panel) {
    return panel_area(panel) * (panel.inset_m > 0.0 ? 0.1 : 1.0);
  };
  for (const Panel& panel : panels)
    area += weight(panel) * (panel.reach == Panel::Reach::whole_width ? 1.0 : 2.0);
  const double quads_per_area = std::max(0.0, triangles - used / 3.0) / 2.0 / area;
  for (const Panel& panel : panels)
    for (int side = 0; side < (panel.reach == Panel::Reach::whole_width ? 1 : 2); ++side)
      add_body_panel(car.pieces[static_cast<std::size_t>(panel.look)].surface, panel, side == 1,
                     quads_per_area * weight(panel));
  out.models = {std::move(car), std::move(wheel)};
  out.placements.push_back({0, {}, 0.0});
  for (const double axle : kAxleX) {
    out.placements.push_back({1, {axle, kWheelRadius, kTrack}, random.uniform(-0.01, 0.01)});
    out.placements.push_back({1, {axle, kWheelRadius, -kTrack}, kPi});
  }
  out.eye = {4.6, 1.7, 4.4};
  out.target = {0.15, 0.6, 0.0};
  out.fov_y_rad = 0.52;
  out.more_views = {{"close_up", {2.93, 0.31, 0.75}, {0.3, 0.85, -0.51}, 0.62},
                    {"distant", {7.12, 2.56, 6.8}, {0.0, 0.6, 0.0}, 0.52}};
  out.sun_direction = {0.7, -1.0, -0.35};
  return out;
}

}  // namespace

Generator car_body() {
  return {{"car_body",
           "car of smooth curved panels with thin highlights; cameras suggested, close_up and distant",
           {{"triangles", 500000, 20000, 20000000, "triangles drawn, within 2 %"},
            {"roughness", 0.3, 0.05, 1, "roughness of paint and chrome; 0.3 is a Phong exponent of 245"},
            {"mouldings", 0, 0, 1,
             "1: mouldings of 6 mm along windows, flank and roof, whose highlights break into beads"},
            seed_parameter()}},
          make};
}

}  // namespace hwsim::pipeline::generate
