#pragma once
// Programs of deferred shading (docs/techniques/deferred.md): G-buffer, classification of pixels, lighting.
#include "algos/base/shaders/counters.h"
#include "algos/base/shaders/gbuffer.h"
#include "pipeline/batch/program.h"
#include "pipeline/batch/uniforms.h"

namespace hwsim::algos {

struct GBufferUniforms {
  glm::mat4 view_from_world{1.0f};
  bool full_varyings = false;
  bool extended = false;  ///< LightingUniforms::extended
};
/// All members by name: a new one that is forgotten here does not compile.
inline void add_content(pipeline::ContentDigest& digest, const GBufferUniforms& uniforms) {
  const auto& [view_from_world, full_varyings, extended] = uniforms;
  digest.add(view_from_world, full_varyings, extended);
}
/// Writes the layout's attachments. Here and below, `extended` is the lighting's.
const pipeline::FragmentProgram& gbuffer_program(GBufferEncoding encoding, bool full_varyings,
                                                 bool alpha_test, bool extended = false);

/// Discards pixels whose samples are alike by Lauritzen's criteria
/// (docs/techniques/deferred.md#simple-and-complex).
const pipeline::FragmentProgram& classify_program(GBufferEncoding encoding);
/// Lights sample 0 at pixel rate, or the invocation's sample at sample rate.
const pipeline::FragmentProgram& deferred_light_program(GBufferEncoding encoding, bool extended = false);
/// 16x16 tiles: lights culled against the tile's depth bounds, sample 0 of each pixel lit, further samples of
/// complex pixels redistributed over the group.
const pipeline::ComputeProgram& tile_light_program(GBufferEncoding encoding, bool extended = false,
                                                   bool means = false);

}  // namespace hwsim::algos
