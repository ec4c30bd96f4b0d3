#pragma once
// Filters of a finished image (docs/techniques/filters.md). Images between filters hold perceptual color:
// sRGB codes in rgba8_srgb or rgba8_unorm, read and presented by whichever of the two views a pass needs.
#include "algos/base/technique.h"

namespace hwsim::algos {

Room filter_room();

}  // namespace hwsim::algos
