#pragma once
// No anti-aliasing, supersampling and multisampling: forward shading (techniques 1.1 to 1.3).
#include "algos/base/technique.h"

namespace hwsim::algos {

std::span<const TechniqueInfo> forward_techniques();

}  // namespace hwsim::algos
