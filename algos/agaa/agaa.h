#pragma once
// Aggregate G-buffer anti-aliasing (techniques 4; Crassin et al. 2016): dense visibility, few pre-filtered
// surfaces a pixel.
#include "algos/base/technique.h"

namespace hwsim::algos {

Room agaa_room();

}  // namespace hwsim::algos
