#pragma once
// Surface based anti-aliasing (Salvi and Vidimce 2012; techniques 3).
#include "algos/base/technique.h"

namespace hwsim::algos {

std::span<const TechniqueInfo> sbaa_techniques();

}  // namespace hwsim::algos
