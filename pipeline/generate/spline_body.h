#pragma once
// A car's skin: a bicubic B-spline surface over stations along the car and points around its section.
#include "pipeline/generate/exact_math.h"
#include "pipeline/generate/surface.h"

namespace hwsim::pipeline::generate {

constexpr double kStations = 18.0;  ///< parameter `s`: 0 at the rear, kStations at the front
constexpr double kSections = 9.0;   ///< parameter `c`: 0 at the sill, kSections on the center line
constexpr double kAxleX[2] = {1.47, -1.255};
constexpr double kWheelRadius = 0.316, kArchRadius = 0.362;

/// The left half (z >= 0) where mirror is false. Front is +x.
glm::dvec3 body_point(double s, double c);
glm::dvec3 body_normal(double s, double c);

/// A part of the skin between gaps; its edges are rolled inward with a small radius, where highlights run.
struct Panel {
  enum class Reach {
    side,
    arched_side,  ///< the lower edge follows the wheel arches
    whole_width   ///< over the center line to the other side's c0
  };
  double s0, s1, c0, c1;
  int look = 0;
  Reach reach = Reach::side;
  double inset_m = 0.0;  ///< below the skin
};

/// In square meters, of one side or of the whole width.
double panel_area(const Panel& panel);

/// About `quads` quads of about equal size; `mirrored`: the right side's panel.
void add_body_panel(MeshSurface& s, const Panel& panel, bool mirrored, double quads);

}  // namespace hwsim::pipeline::generate
