#include "pipeline/generate/registry.h"

#include <vector>

namespace hwsim::pipeline::generate {

std::span<const Generator> registry() {
  static const std::vector<Generator> generators = {
      // constant data; the only list a new generator joins
      sponza_hall(), grass(),    powerplant(), dragon(), wires(), text_page(), old_city(),
      foliage(),     car_body(), fur_ball(),   bamboo(), metal(), grill(),
  };
  return generators;
}

GeneratorParameter seed_parameter() { return {"seed", 1, 0, 4294967295.0, "seed of the random numbers"}; }

GeneratorParameter fov_parameter(double default_deg) {
  return {"fov_deg", default_deg, 1, 150, "vertical field of view in degrees"};
}

}  // namespace hwsim::pipeline::generate
