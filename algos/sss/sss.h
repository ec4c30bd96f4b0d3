#pragma once
// Selective shader supersampling (techniques 5): 8x multisampling, and further samples on the few triangles
// whose highlights it would tear into beads.
#include <span>

#include "algos/base/technique.h"

namespace hwsim::algos {

std::span<const TechniqueInfo> sss_techniques();

}  // namespace hwsim::algos
