#pragma once
// G-buffer and deferred lighting (docs/techniques/deferred.md).
#include <array>

#include "algos/base/shaders/gbuffer_layouts.h"
#include "pipeline/batch/program.h"
#include "pipeline/shade/lighting.h"
#include "pipeline/state/pipeline_state.h"

namespace hwsim::algos {

/// Image slots of lighting passes: the layout's attachments in order, then depth where the encoding has no
/// position. The shadow map follows them.
constexpr int depth_slot(GBufferEncoding encoding) { return encoding == GBufferEncoding::record ? -1 : 3; }

struct GBufferUniforms {
  glm::mat4 view_from_world{1.0f};
  bool full_varyings = false;
};
/// Writes the layout's attachments.
const pipeline::FragmentProgram& gbuffer_program(GBufferEncoding encoding, bool full_varyings,
                                                 bool alpha_test);

struct DeferredUniforms {
  pipeline::LightingUniforms lighting;
  glm::mat4 world_from_clip{1.0f};
  glm::mat4 view_from_clip{1.0f};
  glm::mat4 view_from_world{1.0f};
  glm::vec3 background{0.0f};
  int width = 1, height = 1, samples = 1;
  std::array<pipeline::SamplePosition, 32> positions{};
  float normal_dot_min = 0.99f;
  float z_scale = 1.0f;
  bool compare_all = false;
};

/// Discards pixels whose samples are alike by Lauritzen's criteria
/// (docs/techniques/deferred.md#simple-and-complex).
const pipeline::FragmentProgram& classify_program(GBufferEncoding encoding);
/// Lights sample 0 at pixel rate, or the invocation's sample at sample rate.
const pipeline::FragmentProgram& deferred_light_program(GBufferEncoding encoding);
/// 16x16 tiles: lights culled against the tile's depth bounds, sample 0 of each pixel lit, further samples of
/// complex pixels redistributed over the group.
const pipeline::ComputeProgram& tile_light_program(GBufferEncoding encoding);

/// Copies image 0 sample by sample.
const pipeline::FragmentProgram& copy_samples_program();

}  // namespace hwsim::algos
