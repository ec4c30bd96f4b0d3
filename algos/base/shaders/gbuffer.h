#pragma once
// What shaders that read a G-buffer are handed: the slots of its images, the lights and the view.
#include <array>

#include "algos/base/shaders/gbuffer_layouts.h"
#include "pipeline/batch/uniforms.h"
#include "pipeline/shade/lighting.h"
#include "pipeline/state/pipeline_state.h"

namespace hwsim::algos {

/// Image slots of lighting passes: the layout's attachments in order, then depth where the encoding has no
/// position. The shadow map follows them.
constexpr int depth_slot(GBufferEncoding encoding) {
  return encoding == GBufferEncoding::record ? -1 : encoding == GBufferEncoding::split ? 4 : 3;
}

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
  bool mean_in_tiles = false;  ///< compute tiles write the mean of a pixel's samples, not the samples
};
/// All members by name: a new one that is forgotten here does not compile.
inline void add_content(pipeline::ContentDigest& digest, const DeferredUniforms& uniforms) {
  const auto& [lighting, world_from_clip, view_from_clip, view_from_world, background, width, height, samples,
               positions, normal_dot_min, z_scale, compare_all, mean_in_tiles] = uniforms;
  digest.add(lighting, world_from_clip, view_from_clip, view_from_world, background, width, height, samples,
             positions, normal_dot_min, z_scale, compare_all, mean_in_tiles);
}

}  // namespace hwsim::algos
