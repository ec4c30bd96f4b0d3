#pragma once
// Cameras that no scene holds: where one stands and looks, in words that take the place of a camera's name.
#include <optional>
#include <string>
#include <string_view>

#include "pipeline/scene/scene.h"

namespace hwsim::lab {

/// "eye=1,2,3 target=0,0,0 fov=60": meters in the scene's own space, y up; degrees from the bottom to the top
/// of the picture, 60 without it. None for what does not begin with "eye=", which names a camera of the
/// scene. Throws InputError U009 for words that place no camera.
std::optional<pipeline::Camera> free_camera(std::string_view words);

/// The scene with the camera behind its own; near and far planes from the scene's bounds.
pipeline::Scene with_camera(pipeline::Scene scene, pipeline::Camera camera);

}  // namespace hwsim::lab
