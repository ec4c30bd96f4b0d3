#pragma once
// Materials that ask for more than a G-buffer may hold: what techniques say they lose is said by name.
#include <string>
#include <vector>

#include "pipeline/scene/scene.h"

namespace hwsim::pipeline {

struct SpecialSurface {
  std::string material;  ///< its name; "materials[3]" without one
  bool blended = false;
  bool emissive = false;          ///< shines
  bool colored_emission = false;  ///< and in another color than gray
  bool unlit = false;
  bool occluded = false;  ///< a texture keeps ambient light off
  bool operator==(const SpecialSurface&) const = default;
};

/// The materials that something drawn has and of which one of these is true, in the scene's order.
std::vector<SpecialSurface> special_surfaces(const Scene& scene);

/// Whether some mesh has an unlit material.
bool has_unlit(const Scene& scene);
/// Whether some mesh has a material that is metal, in whole or in part, and there is ambient light.
bool has_metal_in_ambient_light(const Scene& scene);

}  // namespace hwsim::pipeline
