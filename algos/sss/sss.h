#pragma once
// Selective shader supersampling (docs/techniques/sss.md): 8x multisampling, and further samples on the few
// triangles whose highlights it would tear into beads.
#include "algos/base/technique.h"

namespace hwsim::algos {

Room sss_room();

}  // namespace hwsim::algos
