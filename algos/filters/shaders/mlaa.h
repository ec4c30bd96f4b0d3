#pragma once
// The three passes of MLAA on a GPU (docs/techniques/filters.md#mlaa).
#include "pipeline/batch/program.h"

namespace hwsim::algos {

struct MlaaUniforms {
  float threshold = 1.0f / 32.0f;
  bool wide_counts = false;  ///< counts of 8 bits with their stop bit, otherwise of 4
};

/// Image slot 0: perceptual color. Bit 0: an edge to the pixel above, bit 1: to the pixel on the right.
const pipeline::FragmentProgram& mlaa_edge_program();
/// Image slot 0: edges. For both edges of a pixel, how far its run goes on each way, and whether it ends
/// there.
const pipeline::FragmentProgram& mlaa_count_program();
/// Image slots: color, edges, counts.
const pipeline::FragmentProgram& mlaa_blend_program();

}  // namespace hwsim::algos
