#include "pipeline/emulate/material_views.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace hwsim::pipeline {
namespace {

void set_transform(const glm::mat4& world_from_local, DrawInfo& draw) {
  std::memcpy(draw.world_from_local, glm::value_ptr(world_from_local), sizeof(draw.world_from_local));
  draw.mirrored = is_mirrored(world_from_local);
  const glm::mat3 normal = normal_from_local(world_from_local);
  std::memcpy(draw.normal_from_local, glm::value_ptr(normal), sizeof(draw.normal_from_local));
}

// Normals are made of products of two elements, and normalized by squares of those: beyond a millionth or a
// million the elements are divided by the largest one's power of two, which changes no direction.
glm::mat3 into_range(const glm::mat3& linear) {
  float largest = 0.0f;
  for (int i = 0; i < 9; ++i) largest = std::max(largest, std::abs(linear[i / 3][i % 3]));
  if (largest == 0.0f || (largest > 0x1p-20f && largest < 0x1p20f)) return linear;
  const int exponent = std::ilogb(largest);
  glm::mat3 out;
  for (int i = 0; i < 9; ++i) out[i / 3][i % 3] = std::ldexp(linear[i / 3][i % 3], -exponent);
  return out;
}

void set_culling(CullMode cull, bool double_sided, DrawInfo& draw) {
  const bool back = cull == CullMode::back && !double_sided, front = cull == CullMode::front;
  draw.cull_back = draw.mirrored ? front : back;
  draw.cull_front = draw.mirrored ? back : front;
}

}  // namespace

bool is_mirrored(const glm::mat4& world_from_local) {
  // In double: the product of three scales of 1e-18 leaves a float's range.
  return glm::determinant(glm::dmat3(glm::mat3(world_from_local))) < 0.0;
}

glm::mat3 normal_from_local(const glm::mat4& world_from_local) {
  const glm::mat3 linear = into_range(glm::mat3(world_from_local));
  // The cofactor matrix is the inverse transpose times the determinant: it needs no division, so it also
  // serves transforms that flatten; the sign keeps normals on their side.
  const glm::mat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                           glm::cross(linear[0], linear[1]));
  return cofactor * (is_mirrored(world_from_local) ? -1.0f : 1.0f);
}

MaterialView make_material_view(const Material& material, int index, const TextureStore& textures) {
  MaterialView view;
  for (int i = 0; i < 4; ++i) view.base_color[i] = material.base_color[i];
  for (int i = 0; i < 3; ++i) view.emissive[i] = material.emissive[i];
  view.metallic = material.metallic;
  view.roughness = material.roughness;
  view.normal_scale = material.normal_scale;
  view.occlusion_strength = material.occlusion_strength;
  view.alpha_cutoff = material.alpha_cutoff;
  view.alpha_test = material.alpha_mode == AlphaMode::mask;
  view.double_sided = material.double_sided;
  view.unlit = material.model == ShadingModel::unlit;
  view.index = index;
  view.base_color_texture = textures.view(material.base_color_texture);
  view.metallic_roughness_texture = textures.view(material.metallic_roughness_texture);
  view.normal_texture = textures.view(material.normal_texture);
  view.emissive_texture = textures.view(material.emissive_texture);
  view.occlusion_texture = textures.view(material.occlusion_texture);
  return view;
}

bool needs_full_varyings(const Scene& scene) {
  return std::any_of(scene.meshes.begin(), scene.meshes.end(),
                     [](const Mesh& mesh) { return !mesh.tangents.empty() || !mesh.colors.empty(); }) ||
         std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) {
           for (const TextureRef* ref : {&m.base_color_texture, &m.metallic_roughness_texture,
                                         &m.normal_texture, &m.emissive_texture, &m.occlusion_texture})
             if (ref->texture >= 0 && ref->uv_set == 1) return true;
           return false;
         });
}

MaterialViews::MaterialViews(const Scene& scene, const TextureStore& textures) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    views_.push_back(make_material_view(scene.materials[i], static_cast<int>(i), textures));
  for (const Mesh& mesh : scene.meshes) {
    std::vector<VertexRange>& of_mesh = ranges_.emplace_back();
    for (const Mesh::Part& part : mesh.parts) {
      if (!mesh.colors.empty()) views_[static_cast<std::size_t>(part.material)].has_colors = true;
      std::uint32_t low = ~0u, high = 0;  // a loop that compilers put on registers: minmax_element they don't
      for (std::uint32_t i = part.first_index; i < part.first_index + part.index_count; ++i) {
        low = std::min(low, mesh.indices[i]);
        high = std::max(high, mesh.indices[i]);
      }
      of_mesh.push_back(part.index_count == 0 ? VertexRange{} : VertexRange{low, high - low + 1});
    }
  }
}

std::vector<DrawInfo> MaterialViews::make_draws(const Pass& pass, const Scene& scene) const {
  std::vector<DrawInfo> draws;
  for (const DrawBatch& batch : pass.batches) {
    for (const DrawCall& call : batch.draws) {
      const Instance& instance = scene.instances[static_cast<std::size_t>(call.instance)];
      const auto mesh = static_cast<std::size_t>(instance.mesh);
      const auto part = static_cast<std::size_t>(call.part);
      DrawInfo draw;
      draw.batch = &batch;
      draw.mesh = &scene.meshes[mesh];
      draw.mesh_number = static_cast<std::uint32_t>(mesh);
      draw.part = &draw.mesh->parts[part];
      draw.material = &views_[static_cast<std::size_t>(draw.part->material)];
      draw.first_vertex = call.list ? call.list->first_vertex : ranges_[mesh][part].first;
      draw.vertex_count = call.list ? call.list->vertex_count : ranges_[mesh][part].count;
      draw.indices =
          call.list ? call.list->indices.data() : draw.mesh->indices.data() + draw.part->first_index;
      draw.index_count =
          call.list ? static_cast<std::uint32_t>(call.list->indices.size()) : draw.part->index_count;
      draw.first_index = draw.part->first_index + (call.list ? 1u << 29 : 0u);
      draw.index_bytes = call.list ? 4 : std::max(2, draw.mesh->index_bytes);
      set_transform(instance.world_from_local, draw);
      set_culling(batch.state.raster.cull, draw.material->double_sided, draw);
      draws.push_back(draw);
    }
  }
  return draws;
}

}  // namespace hwsim::pipeline
