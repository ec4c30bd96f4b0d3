#pragma once
// Aggregate G-buffer anti-aliasing (docs/techniques/agaa.md; Crassin et al. 2016): dense visibility, few
// pre-filtered surfaces a pixel.
#include "algos/base/technique.h"

namespace hwsim::algos {

Room agaa_room();

}  // namespace hwsim::algos
