#pragma once
// The exposure of a file's lights. glTF's lights are in lux and candela, many files' in units of their own. A
// picture of 8 bits holds 0 to 1, so lights that are far brighter are scaled down, as a camera does.
#include <span>

#include "pipeline/gltf/placement.h"
#include "pipeline/scene/scene.h"

namespace hwsim::pipeline::gltf {

/// The light that falls on a white surface in the scene at most: all directional lights, and point and spot
/// lights at the scene's center, or half a diagonal away where they stand inside of it.
double illuminance(std::span<const Light> lights, const Box& bounds);

/// 1 up to an illuminance of 20: so bright scenes are meant as they are. Beyond, its inverse.
double automatic_exposure(std::span<const Light> lights, const Box& bounds);

}  // namespace hwsim::pipeline::gltf
