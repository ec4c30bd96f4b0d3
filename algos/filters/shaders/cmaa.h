#pragma once
// The four passes of CMAA (docs/techniques/filters.md#cmaa). An invocation works on 2x2 pixels of the image;
// a depth image of half the size holds which of them are still of interest.
#include "pipeline/batch/program.h"

namespace hwsim::algos {

struct CmaaUniforms {
  float threshold = 1.0f / 13.0f;
  bool average_quirk =
      true;  ///< pruning takes the mean of the last four neighbors, as the public source does
};

/// Image slot 0: perceptual color. Strengths of each pixel's edges to the right and below, four bits each;
/// depth 1 where there are some. Pixels at such edges are copied to target 0.
const pipeline::FragmentProgram& cmaa_edge_program();
/// Image slot 0: strengths. Target 0, where a pixel has some: locally dominant edges, bit 0 to the right, bit
/// 1 below, and bit 7.
const pipeline::FragmentProgram& cmaa_prune_program();
/// Image slot 0: dominant edges. Target 0: all four edges of each pixel; depth 1 where a pixel has two or
/// more.
const pipeline::FragmentProgram& cmaa_combine_program();
/// Image slots: edges of pixels, copied color. Target 0: blended simple shapes; target 1: lines, over them.
const pipeline::FragmentProgram& cmaa_blend_program();

}  // namespace hwsim::algos
