#pragma once
// The lights of a frame. How surfaces reflect them: shade/lighting-inl.h.
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "pipeline/batch/uniforms.h"
#include "pipeline/scene/scene.h"

namespace hwsim::pipeline {

struct DirectionalLight {
  glm::vec3 to_light{0.0f, 1.0f, 0.0f};  ///< unit length
  glm::vec3 color{0.0f};
  bool shadowed = false;
};
/// All members by name: a new one that is forgotten here does not compile.
inline void add_content(ContentDigest& digest, const DirectionalLight& uniforms) {
  const auto& [to_light, color, shadowed] = uniforms;
  digest.add(to_light, color, shadowed);
}

struct PointLight {
  glm::vec3 position{0.0f};
  float inv_range2 = 1.0f;  ///< 1 / range^2, per m^2
  glm::vec3 color{0.0f};
  float cos_outer =
      -2.0f;  ///< spots: falls off from cos_inner to cos_outer around `axis`; -2: all directions
  glm::vec3 axis{0.0f, -1.0f, 0.0f};
  float inv_cos_span = 1.0f;
};
/// All members by name: a new one that is forgotten here does not compile.
inline void add_content(ContentDigest& digest, const PointLight& uniforms) {
  const auto& [position, inv_range2, color, cos_outer, axis, inv_cos_span] = uniforms;
  digest.add(position, inv_range2, color, cos_outer, axis, inv_cos_span);
}

/// All lights of a frame. The vectors hold at least one element, so that a shader can be counted without a
/// scene.
struct LightingUniforms {
  glm::vec3 eye{0.0f};
  glm::vec3 ambient{0.0f};
  ShadingModel model = ShadingModel::blinn_phong;
  /// Shaders know unlit surfaces, whose mark G-buffers hold, and reflect ambient light by their specular
  /// color too. Where a scene needs neither they are spared the operations.
  bool extended = false;
  int directional_count = 0, point_count = 0;
  std::vector<DirectionalLight> directional = std::vector<DirectionalLight>(1);
  std::vector<PointLight> points = std::vector<PointLight>(1);
  glm::mat4 shadow_from_world{1.0f};  ///< to (texel x, texel y, depth 0..1, 1)
  int shadow_slot = -1;               ///< image slot of the shadow map; -1: none
  float shadow_offset_m = 0.0f;  ///< receivers are moved along their normal by this before the comparison
  float shadow_bias = 0.0f;      ///< and by this in depth
};
/// All members by name: a new one that is forgotten here does not compile.
inline void add_content(ContentDigest& digest, const LightingUniforms& uniforms) {
  const auto& [eye, ambient, model, extended, directional_count, point_count, directional, points,
               shadow_from_world, shadow_slot, shadow_offset_m, shadow_bias] = uniforms;
  digest.add(eye, ambient, model, extended, directional_count, point_count, directional, points,
             shadow_from_world, shadow_slot, shadow_offset_m, shadow_bias);
}

/// Whether some mesh has an unlit material.
bool needs_extended_shading(const Scene& scene);

LightingUniforms make_lighting(const Scene& scene, const Camera& camera);

}  // namespace hwsim::pipeline
