#pragma once
// Light-indexed forward shading (docs/techniques/forward.md#light-lists).
#include "algos/base/technique.h"

namespace hwsim::algos {

TechniqueInfo forward_plus_technique();

}  // namespace hwsim::algos
