#pragma once
// The programs of passes that benchmarks run.
#include "pipeline/batch/program.h"

namespace hwsim::benchmarks {

/// Color = the three varyings of gouraud_vertex_program, interpolated: the cheapest shaded pass.
const pipeline::FragmentProgram& gouraud_program();
/// Positions, and normals passed on as colors.
const pipeline::VertexProgram& gouraud_vertex_program();

}  // namespace hwsim::benchmarks
