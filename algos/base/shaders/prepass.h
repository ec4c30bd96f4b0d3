#pragma once
// Programs of depth pre-passes, beside alpha_test_program (forward.h).
#include "algos/base/shaders/forward.h"

namespace hwsim::algos {

/// Discards below the material's cutoff as shading does: base color, texture and vertex color. Over
/// mesh_full_program; no color.
const pipeline::FragmentProgram& full_alpha_test_program();

}  // namespace hwsim::algos
