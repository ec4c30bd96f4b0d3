#include "pipeline/scene/special_surfaces.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "pipeline/image/image.h"

namespace hwsim::pipeline {
namespace {

/// A hundredth of the brightest channel, and half a step of eight bits: what nobody sees is no color.
bool is_colored(const glm::vec3& light) {
  const float most = std::max({light.x, light.y, light.z}), least = std::min({light.x, light.y, light.z});
  return most - least > std::max(0.01f * most, 0.5f / 255.0f);
}

bool shines_in_color(const Scene& scene, const Material& material) {
  const glm::vec3& factor = material.emissive;
  if (material.emissive_texture.texture < 0) return is_colored(factor);
  const auto texture = static_cast<std::size_t>(material.emissive_texture.texture);
  const auto& light_of = srgb_decode_table();
  const auto& texels = levels_of(scene, texture).front().texels;
  return std::any_of(texels.begin(), texels.end(), [&](std::uint32_t texel) {
    return is_colored(
        factor * glm::vec3(light_of[texel & 255], light_of[texel >> 8 & 255], light_of[texel >> 16 & 255]));
  });
}

std::vector<bool> drawn_materials(const Scene& scene) {
  std::vector<bool> drawn(scene.materials.size(), false);
  for (const Instance& instance : scene.instances)
    for (const Mesh::Part& part : scene.meshes[static_cast<std::size_t>(instance.mesh)].parts)
      if (part.index_count > 0) drawn[static_cast<std::size_t>(part.material)] = true;
  return drawn;
}

template <class Is>
bool any_part(const Scene& scene, Is is) {
  return std::any_of(scene.meshes.begin(), scene.meshes.end(), [&](const Mesh& mesh) {
    return std::any_of(mesh.parts.begin(), mesh.parts.end(), [&](const Mesh::Part& part) {
      return is(scene.materials[static_cast<std::size_t>(part.material)]);
    });
  });
}

}  // namespace

bool has_unlit(const Scene& scene) {
  return any_part(scene, [](const Material& m) { return m.model == ShadingModel::unlit; });
}

bool has_metal_in_ambient_light(const Scene& scene) {
  return scene.ambient != glm::vec3(0.0f) && any_part(scene, [](const Material& m) {
           return m.metallic > 0.0f && m.model != ShadingModel::unlit;
         });
}

std::vector<SpecialSurface> special_surfaces(const Scene& scene) {
  const std::vector<bool> drawn = drawn_materials(scene);
  std::vector<SpecialSurface> found;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (!drawn[i]) continue;
    const Material& material = scene.materials[i];
    SpecialSurface surface;
    surface.unlit = material.model == ShadingModel::unlit;
    surface.emissive = !surface.unlit && material.emissive != glm::vec3(0.0f);
    surface.colored_emission = surface.emissive && shines_in_color(scene, material);
    surface.occluded = !surface.unlit && material.occlusion_texture.texture >= 0 &&
                       material.occlusion_strength > 0.0f && scene.ambient != glm::vec3(0.0f);
    if (!surface.unlit && !surface.emissive && !surface.occluded) continue;
    surface.material = material.name.empty() ? "materials[" + std::to_string(i) + "]" : material.name;
    surface.blended = material.alpha_mode == AlphaMode::blend;
    found.push_back(surface);
  }
  return found;
}

}  // namespace hwsim::pipeline
