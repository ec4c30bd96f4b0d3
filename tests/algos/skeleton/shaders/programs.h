#pragma once
// The skeleton's program, and what it is handed.
#include "algos/skeleton/shaders/counters.h"
#include "pipeline/batch/program.h"

namespace hwsim::algos {

struct SkeletonUniforms {
  int samples = 4;
  float tolerance = 0.0f;
};

/// Image slot 0: the multisampled color. Color: its mean where the samples differ, else the first of them.
const pipeline::FragmentProgram& skeleton_resolve_program();

}  // namespace hwsim::algos
