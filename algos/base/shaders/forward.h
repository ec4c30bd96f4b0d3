#pragma once
// Programs of forward shading, and of depth alone.
#include "algos/base/shaders/counters.h"
#include "pipeline/batch/program.h"
#include "pipeline/batch/uniforms.h"
#include "pipeline/shade/lighting.h"

namespace hwsim::algos {

struct ForwardUniforms {
  pipeline::LightingUniforms lighting;
  bool full_varyings = false;  ///< tangents and vertex colors are interpolated
};
/// All members by name: a new one that is forgotten here does not compile.
inline void add_content(pipeline::ContentDigest& digest, const ForwardUniforms& uniforms) {
  const auto& [lighting, full_varyings] = uniforms;
  digest.add(lighting, full_varyings);
}

/// Material and all lights in one pass; color 0 is linear RGBA. `alpha_test`: discards below the material's
/// cutoff.
const pipeline::FragmentProgram& forward_program(bool full_varyings, bool alpha_test, bool extended = false);

struct AlphaTestUniforms {};
/// Discards below the material's cutoff; no color. For depth-only passes over mesh_uv_program.
const pipeline::FragmentProgram& alpha_test_program();

}  // namespace hwsim::algos
