#include "benchmarks/pass_programs.h"

#include "pipeline/shade/mesh_vertex.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "benchmarks/pass_programs.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/shade/count_fragment-inl.h"
#include "pipeline/shade/fragment_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::benchmarks::HWY_NAMESPACE {
struct GouraudShader {
  struct Uniforms {};
  template <class S>
  static void run(S& s, const Uniforms&) {
    s.output(0, {s.attr(0), s.attr(1), s.attr(2), typename S::F(1.0f)});
  }
};

void run_gouraud(pipeline::FragmentBatch& b, const void* u) {
  pipeline::HWY_NAMESPACE::run_fragment_shader<GouraudShader>(b, u);
}
}  // namespace hwsim::benchmarks::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::benchmarks {
HWY_EXPORT(run_gouraud);

const pipeline::FragmentProgram& gouraud_program() {
  static const pipeline::FragmentProgram program = [] {
    pipeline::FragmentProgram p =
        pipeline::HWY_NAMESPACE::describe_fragment_shader<HWY_NAMESPACE::GouraudShader>(
            "gouraud", [](pipeline::FragmentBatch& b, const void* u) {
              HWY_DYNAMIC_DISPATCH(run_gouraud)(b, u);
            });
    p.varying_scalars = pipeline::SurfaceVaryings::kBasic;
    return p;
  }();
  return program;
}

const pipeline::VertexProgram& gouraud_vertex_program() { return pipeline::mesh_surface_program(); }

}  // namespace hwsim::benchmarks
#endif
