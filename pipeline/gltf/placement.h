#pragma once
// Where a file's coordinates go: arithmetic is in single precision, so a scene at map coordinates, or one of
// a picometer, is moved and scaled in double precision while it is loaded.
#include <glm/glm.hpp>
#include <vector>

#include "pipeline/scene/scene.h"

namespace hwsim::pipeline::gltf {

/// Axis-aligned, in double precision; holds nothing at first.
struct Box {
  glm::dvec3 low{1e300}, high{-1e300};
  bool empty() const { return low.x > high.x; }
  void add(const glm::dvec3& point);
  void add(const Box& local, const glm::dmat4& matrix);  ///< the box around the eight moved corners
  double diagonal() const { return empty() ? 0.0 : glm::length(high - low); }
  glm::dvec3 center() const { return empty() ? glm::dvec3(0.0) : low * 0.5 + high * 0.5; }
};

/// new = (old - origin) * scale. Both are powers of ten or sums of them: a scene that somebody moved by a
/// round number of meters, or scaled by a thousand, comes back to the very same numbers.
struct Placement {
  glm::dvec3 origin{0.0};
  double scale = 1.0;
  bool within_range = true;         ///< it was before: at most the nodes' shared scale is undone
  double units_per_option_m = 1.0;  ///< Scene::units_per_option_m
  bool is_identity() const { return origin == glm::dvec3(0.0) && scale == 1.0; }
  glm::dmat4 matrix() const;          ///< from old to new
  glm::dmat4 inverse_matrix() const;  ///< from new to old
};

/// For a mesh's own coordinates: moved where its center lies more than two diagonals from zero, scaled where
/// its diagonal leaves 1e-5 to 1e7.
Placement place_mesh(const Box& bounds);

/// By how much the nodes of a file enlarge what they draw.
struct DrawnScale {
  double shared = 1.0;   ///< all of them, to six digits; 1: nothing in common
  double largest = 0.0;  ///< one of them; 0: nothing is drawn
};

/// To the six digits that are left of a scale in a matrix of floats.
double rounded_scale(double scale);

/// For the whole scene: what all nodes share of their scales is undone, so that a scene has the same numbers
/// in whatever unit it was written. It is moved as a mesh is, and scaled further where its diagonal leaves
/// 0.1 to 1e5; the first choice is to undo the largest scale. What lies inside keeps its bits.
/// `view_distance_m`: of the farthest camera from the center, which must stay inside float's range too.
Placement place_scene(const Box& bounds, const DrawnScale& drawn, double view_distance_m);

Box bounds_of(const std::vector<glm::vec3>& positions);

}  // namespace hwsim::pipeline::gltf
