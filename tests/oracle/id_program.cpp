#include "oracle/id_program.h"

// Without foreach_target: one vector target is enough for a test.
#include "pipeline/shade/fragment_lanes-inl.h"
#include "pipeline/shade/surface-inl.h"

namespace hwsim::oracle {
namespace {
using pipeline::FragmentBatch;
using pipeline::FragmentProgram;
namespace lanes = pipeline::HWY_NAMESPACE;

struct DiscardShader {
  struct Uniforms {};
  template <class S>
  static void run(S& s, const Uniforms&) {
    s.discard(lanes::sample_alpha(s, 0) < typename S::F(s.material().alpha_cutoff));
  }
};

void write_ids(FragmentBatch& batch, const void*) {
  for (int lane = 0; lane < 4 * batch.quad_count; ++lane)
    batch.color[0][0][lane] = static_cast<float>(batch.primitive[static_cast<std::size_t>(lane / 4)]);
}

void write_tested_ids(FragmentBatch& batch, const void*) {
  const DiscardShader::Uniforms none;
  lanes::run_fragment_shader<DiscardShader>(batch, &none);
  write_ids(batch, nullptr);
}

void spread_samples(FragmentBatch& batch, const void* uniforms) {
  const int samples = static_cast<const SampleSpread*>(uniforms)->samples;
  for (std::size_t lane = 0; lane < static_cast<std::size_t>(4 * batch.quad_count); ++lane) {
    const int x = batch.pixel_x[lane], y = batch.pixel_y[lane];
    float rgba[4];
    read_texel(*batch.resources->images[0], x / samples, y, x % samples, rgba);
    batch.color[0][0][lane] = rgba[0];
  }
}

FragmentProgram program(const char* name, void (*run)(FragmentBatch&, const void*), int varying_scalars) {
  FragmentProgram p;
  p.name = name;
  p.run = run;
  p.varying_scalars = varying_scalars;
  return p;
}

}  // namespace

const FragmentProgram& id_program(bool alpha_test) {
  static const FragmentProgram plain = program("id", write_ids, 2);
  static const FragmentProgram tested = [] {
    FragmentProgram p = program("id_alpha_test", write_tested_ids, 2);
    p.can_discard = true;
    return p;
  }();
  return alpha_test ? tested : plain;
}

const FragmentProgram& spread_samples_program() {
  static const FragmentProgram p = program("spread_samples", spread_samples, 0);
  return p;
}

}  // namespace hwsim::oracle
