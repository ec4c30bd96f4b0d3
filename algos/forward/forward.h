#pragma once
// Techniques that shade while they draw: no anti-aliasing, supersampling, multisampling and coverage
// sampling.
#include "algos/base/technique.h"

namespace hwsim::algos {

Room forward_room();

}  // namespace hwsim::algos
