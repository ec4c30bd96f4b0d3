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
  bool is_identity() const { return origin == glm::dvec3(0.0) && scale == 1.0; }
  glm::dmat4 matrix() const;          ///< from old to new
  glm::dmat4 inverse_matrix() const;  ///< from new to old
};

/// For a mesh's own coordinates: moved where its center lies more than two diagonals from zero, scaled where
/// its diagonal leaves 1e-5 to 1e7.
Placement place_mesh(const Box& bounds);

/// For the whole scene: moved likewise, scaled where its diagonal leaves 0.1 m to 1e5 m. What lies inside
/// keeps its bits. `largest_scale`: the largest factor by which a node draws a mesh; the first choice is to
/// undo it. `view_distance_m`: of the farthest camera from the center, which must stay inside float's range
/// too.
Placement place_scene(const Box& bounds, double largest_scale, double view_distance_m);

Box bounds_of(const std::vector<glm::vec3>& positions);

}  // namespace hwsim::pipeline::gltf
