#pragma once
// Materials as shaders see them, and draws ready to run.
#include <vector>

#include "pipeline/emulate/segment.h"
#include "pipeline/texture/texture_view.h"

namespace hwsim::pipeline {

MaterialView make_material_view(const Material& material, int index, const TextureStore& textures);

/// Whether some mesh has tangents or vertex colors, or some texture lies on UV set 1; without, shaders are
/// given SurfaceVaryings up to kBasic.
bool needs_full_varyings(const Scene& scene);

/// Whether a transform turns counter-clockwise triangles around.
bool is_mirrored(const glm::mat4& world_from_local);

/// By which normals follow a transform; not normalized.
glm::mat3 normal_from_local(const glm::mat4& world_from_local);

class MaterialViews {
 public:
  MaterialViews(const Scene& scene, const TextureStore& textures);
  const MaterialView& view(int material) const { return views_[static_cast<std::size_t>(material)]; }
  const MaterialView* views() const { return views_.data(); }
  std::vector<DrawInfo> make_draws(const Pass& pass, const Scene& scene) const;

 private:
  std::vector<MaterialView> views_;
  struct VertexRange {
    std::uint32_t first = 0, count = 0;
  };
  std::vector<std::vector<VertexRange>> ranges_;  ///< by mesh and part
};

}  // namespace hwsim::pipeline
