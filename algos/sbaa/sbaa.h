#pragma once
// Surface based anti-aliasing (docs/techniques/sbaa.md; Salvi and Vidimce 2012): visibility at full rate, a
// G-buffer of the few surfaces that matter in a pixel.
#include "algos/base/technique.h"

namespace hwsim::algos {

Room sbaa_room();

}  // namespace hwsim::algos
