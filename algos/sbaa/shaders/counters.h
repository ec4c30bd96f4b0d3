#pragma once
// What SBAA counts beyond the units: surfaces of its slots, and what became of them.
#include "algos/base/shaders/counters.h"

namespace hwsim::algos {

#define HWSIM_SBAA_COUNTERS(X)                                                                   \
  X(slots_emitted_surfaces, "SBAA: surfaces that the analysis chose for a slot of the G-buffer") \
  X(slots_emitted_first_surfaces, "of these, for a pixel's first slot")                          \
  X(slots_emitted_second_surfaces, "of these, for a pixel's second slot")                        \
  X(slots_emitted_third_surfaces, "of these, for a pixel's third slot")                          \
  X(slots_emitted_further_surfaces, "of these, for a pixel's fourth slot and beyond")            \
  X(merge_fallbacks_surfaces,                                                                    \
    "of these, single primitives: depths of the aligned samples lay in two groups")              \
  X(slots_empty_surfaces, "of these, those that no fragment wrote")                              \
  X(slot_conflicts_fragments, "SBAA: fragments that replaced another one's record in a slot")
HWSIM_TECHNIQUE_COUNTERS(SbaaCounters, 1, HWSIM_SBAA_COUNTERS);

}  // namespace hwsim::algos
