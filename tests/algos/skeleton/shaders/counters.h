#pragma once
// What the skeleton counts beyond the units.
#include "algos/base/shaders/counters.h"

namespace hwsim::algos {

// The text says what one count is. The number is the first free slot of hwsim::TechniqueCounters; a test
// finds slots that two rooms take. The skeleton takes the last one, so that it is never in the way.
#define HWSIM_SKELETON_COUNTERS(X) \
  X(skeleton_mixed_pixels, "pixels whose samples differed by more than the tolerance")
HWSIM_TECHNIQUE_COUNTERS(SkeletonCounters, 39, HWSIM_SKELETON_COUNTERS);

}  // namespace hwsim::algos
