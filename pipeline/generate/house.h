#pragma once
// A house front with bays, shutters and balconies, for generated cities.
#include "pipeline/generate/blueprint.h"
#include "pipeline/generate/exact_math.h"

namespace hwsim::pipeline::generate {

/// Indices into Blueprint::looks.
struct HouseLooks {
  int wall = 0, stone = 0, wood = 0, glass = 0, iron = 0, roof = 0, cloth = 0;
};

struct HouseShape {
  int bays = 3, floors = 3;
  double bay_m = 2.4, floor_m = 3.2, depth_m = 8.0;
  int shutter_slats = 12;  ///< slats that one leaf has
  double bars_per_m = 9.0;
  int sides = 6;  ///< sides that an iron bar has
  HouseLooks looks;
};

/// Stands on y = 0; its front, centered at the origin, faces +z.
Model house_model(Pcg& random, const HouseShape& shape);

}  // namespace hwsim::pipeline::generate
