// A stand-in for the Stanford dragon: a twisted, scaled body of even, tiny triangles. The defaults give what
// the SBAA paper tells of its DRAGON at 1280x720: about 6 triangles (front and back) for each covered pixel,
// about 12 % of the screen covered, and the shaded samples of Table 3.
#include <algorithm>
#include <cmath>

#include "pipeline/generate/exact_math.h"
#include "pipeline/generate/registry.h"

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec3;

struct Body {
  double twist = 0.0, scales = 0.0, around = 0.0, relief_m = 0.0, phase = 0.0;
};

// A trefoil-like spine, flattened so that it stands on the ground.
dvec3 spine(double t) {
  const double a = 2.0 * kPi * t;
  return {1.2 * (exact_sin(a) + 1.6 * exact_sin(2 * a)) / 2.6, 0.9 + 0.45 * exact_sin(3 * a),
          0.8 * (exact_cos(a) - 1.6 * exact_cos(2 * a)) / 2.6};
}

dvec3 body_point(const Body& body, double u, double v) {
  constexpr double kStep = 1.0 / 4096;
  const dvec3 tangent = unit(spine(v + kStep) - spine(v - kStep));
  const dvec3 side = unit(glm::cross(tangent, dvec3(0, 1, 0)));
  const dvec3 up = glm::cross(side, tangent);
  const double angle = -2.0 * kPi * u, along = 2.0 * kPi * v;
  // A ridge that winds around the body, scales, and a body that swells twice.
  const double ridge = exact_cos(3.0 * angle + body.twist * along + body.phase);
  const double scale = exact_sin(body.scales * along) * exact_sin(body.around * angle);
  const double radius =
      0.2 * (1.0 + 0.25 * exact_cos(2.0 * along + body.phase)) + 0.03 * ridge + body.relief_m * scale;
  return spine(v) + (side * exact_cos(angle) + up * exact_sin(angle)) * radius;
}

Blueprint make(const Parameters& p) {
  Pcg random(p.seed());
  const Body body{std::floor(p.number("twist")), std::floor(p.number("scales")),
                  std::floor(p.number("around")), p.number("relief_m"), random.uniform(0.0, 2.0 * kPi)};
  // The body is about 6.7 times as long as it is around: quads are square when rows and columns follow that.
  constexpr double kLengthOverGirth = 6.7;
  const double quads = p.number("triangles") / 2.0;
  const int around = std::max(3, static_cast<int>(std::sqrt(quads / kLengthOverGirth)));
  const int along = std::max(3, static_cast<int>(quads / around));
  Blueprint out;
  out.looks = {{.name = "jade", .color = {0.25, 0.5, 0.3}, .roughness = 0.35}};
  Model model{"dragon", {{MeshSurface{}, 0}}};
  add_grid(model.pieces[0].surface, around, along, true, true,
           [&](double u, double v) { return body_point(body, u, v); });
  out.models.push_back(std::move(model));
  out.placements.push_back({});
  out.eye = {0.495, 2.167, 5.73};
  out.target = {0.0, 0.85, 0.0};
  out.fov_y_rad = 0.61;
  out.near_m = 0.05;
  return out;
}

}  // namespace

Generator dragon() {
  return {{"dragon",
           "dense smooth mesh, about 6 triangles per covered pixel at 1280x720",
           {{"triangles", 675000, 100, 40000000, "triangles, rounded down to whole rings"},
            {"twist", 7, 0, 50, "turns of the ridge around the body, whole"},
            {"scales", 60, 0, 500, "scales along the body, whole"},
            {"around", 24, 1, 500, "scales around the body, whole"},
            {"relief_m", 0.0075, 0, 0.1, "height of a scale in meters"},
            seed_parameter()}},
          make};
}

}  // namespace hwsim::pipeline::generate
