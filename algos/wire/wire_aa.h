#pragma once
// Wire anti-aliasing (docs/techniques/wire.md; GPU Pro 3, ch. 6): wires never thinner than a pixel, faded by
// what they are too wide. A modifier: it goes with every base.
#include "algos/base/technique.h"

namespace hwsim::algos {

Room wire_room();

}  // namespace hwsim::algos
