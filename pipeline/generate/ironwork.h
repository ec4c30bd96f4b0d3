#pragma once
// Thin round bars and what is bent and welded from them.
#include "pipeline/generate/blueprint.h"
#include "pipeline/generate/exact_math.h"

namespace hwsim::pipeline::generate {

/// A torus in the plane of two unit vectors.
void add_ring(MeshSurface& s, const glm::dvec3& center, const glm::dvec3& x, const glm::dvec3& y,
              double radius, double wire_radius, int segments, int sides);

/// A spiral that rolls up in the plane of two unit vectors: from `foot`, along y, turning toward x.
void add_scroll(MeshSurface& s, const glm::dvec3& foot, const glm::dvec3& x, const glm::dvec3& y, double size,
                double wire_radius, int segments, int sides);

struct RailingShape {
  double height_m = 1.0;
  double bars_per_m = 9.0;
  double bar_radius_m = 0.008;
  int sides = 6;
  bool scrolls = true;  ///< ornaments between the bars
  bool spears = false;  ///< pointed bars above the upper rail
};
/// On the line from one point to another, upright.
void add_railing(MeshSurface& s, const glm::dvec3& from, const glm::dvec3& to, const RailingShape& shape);

/// A chair at the origin that faces +z: round legs and back, seat of slats.
void add_chair(MeshSurface& iron, MeshSurface& seat, double bar_radius_m, int sides);

/// A round table at the origin: top, leg and three bent feet.
void add_table(MeshSurface& iron, MeshSurface& top, double radius_m, int sides);

/// A wheel with wire spokes in the plane of x and y through `center`.
void add_spoked_wheel(MeshSurface& iron, MeshSurface& tire, const glm::dvec3& center, const glm::dvec3& x,
                      const glm::dvec3& y, double radius_m, int spokes, int sides);

}  // namespace hwsim::pipeline::generate
