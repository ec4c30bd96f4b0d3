#pragma once
// Programs that show which triangle, and which sample, a pixel came from.
#include "pipeline/batch/program.h"

namespace hwsim::oracle {

/// Color 0: the number of the triangle in its pass, exact below 2^24. Over mesh_uv_program; takes no
/// uniforms. `alpha_test`: discards below the material's cutoff.
const pipeline::FragmentProgram& id_program(bool alpha_test);

struct SampleSpread {
  int samples = 1;
};
/// Full-screen: pixel (x * samples + s, y) shows sample s of pixel (x, y) of image slot 0.
const pipeline::FragmentProgram& spread_samples_program();

}  // namespace hwsim::oracle
