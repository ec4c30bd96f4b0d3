#pragma once
// Aggregate G-buffer anti-aliasing (techniques 4).
#include "algos/base/technique.h"

namespace hwsim::algos {

std::span<const TechniqueInfo> agaa_techniques();

}  // namespace hwsim::algos
