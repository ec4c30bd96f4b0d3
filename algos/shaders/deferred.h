#pragma once
// G-buffer and deferred lighting (techniques 2).
#include <array>

#include "pipeline/graph/pipeline_state.h"
#include "pipeline/shade/lighting.h"
#include "pipeline/shade/program.h"

namespace hwsim::algos {

/// Image slots of lighting passes.
enum GBufferSlot : int {
  kNormalSlot = 0,
  kAlbedoSlot = 1,
  kGradientSlot = 2,
  kDepthSlot = 3,
  kShadowSlot = 4
};

struct GBufferUniforms {
  glm::mat4 view_from_world{1.0f};
  bool full_varyings = false;
};
/// Colors: rgba16_float normal (octahedral) x, y, roughness, emissive luminance; rgba8_srgb base color and
/// metallic; rg16_float view-space dz/dx, dz/dy.
const pipeline::FragmentProgram& gbuffer_program(bool full_varyings, bool alpha_test);

struct DeferredUniforms {
  pipeline::LightingUniforms lighting;
  glm::mat4 world_from_clip{1.0f};
  glm::mat4 view_from_clip{1.0f};
  glm::mat4 view_from_world{1.0f};
  glm::vec3 background{0.0f};
  int width = 1, height = 1, samples = 1;
  std::array<pipeline::SamplePosition, 32> positions{};
  float normal_dot_min = 0.99f;
};

/// Discards pixels whose samples are alike by Lauritzen's criteria (techniques 2.3).
const pipeline::FragmentProgram& classify_program();
/// Lights sample 0 at pixel rate, or the invocation's sample at sample rate.
const pipeline::FragmentProgram& deferred_light_program();
/// 16x16 tiles: lights culled against the tile's depth bounds, sample 0 of each pixel lit, further samples of
/// complex pixels redistributed over the group.
const pipeline::ComputeProgram& tile_light_program();

}  // namespace hwsim::algos
