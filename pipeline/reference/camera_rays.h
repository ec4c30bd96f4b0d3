#pragma once
// A camera's rays through points of the image.
#include "pipeline/scene/scene.h"

namespace hwsim::pipeline {

/// Points origin + t direction, t_min <= t <= t_max; the direction has no unit length.
struct Ray {
  glm::vec3 origin{0.0f}, direction{0.0f, 0.0f, -1.0f};
  float t_min = 0.0f, t_max = 0.0f;
};

/// A ray and how it changes from a pixel to its right and its lower neighbor.
struct PixelRay {
  Ray ray;
  glm::vec3 origin_dx{0.0f}, origin_dy{0.0f}, direction_dx{0.0f}, direction_dy{0.0f};
};

/// Rays in world space through window positions. Along a ray, t is the distance along the optical axis, in
/// meters, and runs from the near to the far plane: what clip-space w is to the rasterizer.
class CameraRays {
 public:
  CameraRays(const Camera& camera, int width, int height);
  /// x right, y down from the upper left corner of the image; the first pixel's center is (0.5, 0.5).
  PixelRay through(double x_px, double y_px) const;

 private:
  glm::dvec3 position_, right_, down_, forward_;  ///< right_ and down_: for one pixel at unit distance
  double half_width_px_, half_height_px_;
  float near_m_, far_m_;
  bool orthographic_;
};

}  // namespace hwsim::pipeline
