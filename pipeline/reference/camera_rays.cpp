#include "pipeline/reference/camera_rays.h"

#include <cmath>

namespace hwsim::pipeline {

CameraRays::CameraRays(const Camera& camera, int width, int height)
    : half_width_px_(width / 2.0),
      half_height_px_(height / 2.0),
      near_m_(camera.near_m),
      far_m_(camera.far_m),
      orthographic_(camera.orthographic) {
  const glm::dmat4 world_from_view = glm::inverse(glm::dmat4(camera.view_from_world));
  // Pixels are square: the aspect ratio is the image's.
  const double pixel = half_height(camera, half_width_px_ / half_height_px_) / half_height_px_;
  position_ = glm::dvec3(world_from_view[3]);
  right_ = glm::dvec3(world_from_view[0]) * pixel;
  down_ = glm::dvec3(world_from_view[1]) * -pixel;
  forward_ = -glm::dvec3(world_from_view[2]);
}

PixelRay CameraRays::through(double x_px, double y_px) const {
  const glm::dvec3 offset = (x_px - half_width_px_) * right_ + (y_px - half_height_px_) * down_;
  PixelRay pixel;
  pixel.ray = {position_, forward_, near_m_, far_m_};
  if (orthographic_) {
    pixel.ray.origin = position_ + offset;
    pixel.origin_dx = right_;
    pixel.origin_dy = down_;
  } else {
    pixel.ray.direction = forward_ + offset;
    pixel.direction_dx = right_;
    pixel.direction_dy = down_;
  }
  return pixel;
}

}  // namespace hwsim::pipeline
