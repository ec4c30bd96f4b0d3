#pragma once
// A camera and a light for scenes whose file has none.
#include "pipeline/scene/scene.h"

namespace hwsim::pipeline {

/// A camera that sees the whole box from in front, above and to the right.
Camera framing_camera(const glm::vec3& bounds_min, const glm::vec3& bounds_max);

/// A far plane just behind the box, for cameras whose file gives none.
float far_plane_m(const Camera& camera, const glm::vec3& bounds_min, const glm::vec3& bounds_max);

/// Whether depths beside each other in the box are one number to a float: the near plane is too near.
bool depths_run_together(const Camera& camera, const glm::vec3& bounds_min, const glm::vec3& bounds_max);

/// A white sun that lights white to 1 and casts shadows, from the upper left in front.
Light default_sun();

}  // namespace hwsim::pipeline
