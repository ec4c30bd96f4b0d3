#pragma once
// What selective supersampling counts beyond the units: triangles, samples and lists.
#include "algos/base/shaders/counters.h"

namespace hwsim::algos {

#define HWSIM_SSS_COUNTERS(X)                                                                     \
  X(sss_tested_primitives, "critical triangles that selective supersampling tested in this view") \
  X(sss_uncritical_primitives, "of these, out of view or not critical in it")                     \
  X(sss_early_exit_primitives, "of these, too far from a highlight")                              \
  X(sss_processed_primitives, "of these, sampled further")                                        \
  X(sss_point_samples, "points placed on them")                                                   \
  X(sss_shaded_samples, "lighting evaluations of the further samples")                            \
  X(sss_stored_fragments, "fragments stored in per-pixel lists")                                  \
  X(sss_dropped_fragments, "fragments that found the lists' memory full: the image lacks them")   \
  X(sss_truncated_pixels, "pixels whose list was longer than the resolve reads")                  \
  X(sss_list_1_pixels, "pixels with one fragment in their list")                                  \
  X(sss_list_2_to_3_pixels, "pixels with 2 or 3")                                                 \
  X(sss_list_4_to_7_pixels, "pixels with 4 to 7")                                                 \
  X(sss_list_8_to_15_pixels, "pixels with 8 to 15")                                               \
  X(sss_list_16_to_31_pixels, "pixels with 16 to 31")                                             \
  X(sss_list_from_32_pixels, "pixels with 32 or more")
HWSIM_TECHNIQUE_COUNTERS(SssCounters, 13, HWSIM_SSS_COUNTERS);

}  // namespace hwsim::algos
