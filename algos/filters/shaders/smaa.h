#pragma once
// The three passes of SMAA 1x (docs/techniques/filters.md#smaa).
#include "pipeline/batch/program.h"

namespace hwsim::algos {

struct SmaaUniforms {
  float threshold = 0.1f;
  bool color_edges = false;  ///< edges by the largest difference of a channel, otherwise by luma
  int search_steps = 16;     ///< steps of two pixels each
  int diagonal_steps = 8;
  float corner_rounding = 0.25f;
  bool corners = true;
};

/// Image slot 0: perceptual color. Red: an edge to the left, green: an edge to the top; others are discarded.
const pipeline::FragmentProgram& smaa_edge_program();
/// Image slots: edges, area table, search table. Weights of the edges on top (r, g) and on the left (b, a).
const pipeline::FragmentProgram& smaa_weight_program(bool diagonals);
/// Image slots: weights, color (linear).
const pipeline::FragmentProgram& smaa_blend_program();

}  // namespace hwsim::algos
