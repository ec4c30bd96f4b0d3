#pragma once
// What AGAA counts beyond the units: aggregates, and where their definition is unsure.
#include "algos/base/shaders/counters.h"

namespace hwsim::algos {

#define HWSIM_AGAA_COUNTERS(X)                                                                \
  X(agaa_aggregates, "AGAA: aggregates that the clustering of pixels' samples made")          \
  X(agaa_plane_split_pixels, "AGAA: pixels in which it made several aggregates of one plane") \
  X(agaa_mixed_code_fragments, "AGAA: fragments whose samples belong to several aggregates")  \
  X(agaa_plane_path_pixels, "AGAA: pixels whose samples were clustered by their depth tile's planes")
HWSIM_TECHNIQUE_COUNTERS(AgaaCounters, 9, HWSIM_AGAA_COUNTERS);

}  // namespace hwsim::algos
