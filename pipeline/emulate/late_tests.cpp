#include "pipeline/emulate/pass_context.h"

namespace hwsim::pipeline {

bool tests_late(const PipelineState& state, const FragmentProgram* program) {
  if (program == nullptr || state.force_early_z || !(state.depth.test || state.stencil.test)) return false;
  const bool drops_samples = program->can_discard || program->writes_mask || state.coverage.alpha_to_coverage;
  return program->writes_storage || (drops_samples && (state.depth.write || state.stencil.test));
}

bool rejects_early(const PipelineState& state, const FragmentProgram* program) {
  if (!state.coverage.alpha_to_coverage || state.coverage.override_output) return false;
  return tests_late(state, program) && !program->writes_storage && state.depth.test && !state.stencil.test;
}

}  // namespace hwsim::pipeline
