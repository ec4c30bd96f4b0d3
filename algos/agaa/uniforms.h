#pragma once
// What AGAA's shaders are handed that does not depend on the frame graph.
#include "algos/agaa/shaders/programs.h"
#include "pipeline/scene/scene.h"

namespace hwsim::algos {

/// The rays of the pixels of a frame of this size.
PixelRays center_rays(const pipeline::Camera& camera, const glm::mat4& view_from_clip, int width, int height);

/// Places and weights of `taps` along an aggregate's main axis, in standard deviations.
void set_shadow_taps(ShadeUniforms& u, int taps);

/// Points on the hemisphere for as many visible normals of SGGX.
void set_hemisphere(ShadeUniforms& u, int visible_normals);

}  // namespace hwsim::algos
