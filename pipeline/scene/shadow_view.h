#pragma once
// How a light that casts shadows sees a scene.
#include "pipeline/scene/scene.h"

namespace hwsim::pipeline {

/// The light whose shadows are drawn: the first directional one that casts them. Null: none does.
const Light* shadow_caster(const Scene& scene);

/// An orthographic view along the light that holds the whole scene. `to_light`: unit length.
glm::mat4 shadow_clip_from_world(const Scene& scene, const glm::vec3& to_light);

/// Texels a meter along the sides of such a view's map, which has `map_px` texels a side, on a plane across
/// the light.
glm::vec2 shadow_texels_per_m(const glm::mat4& shadow_clip_from_world, int map_px);

}  // namespace hwsim::pipeline
