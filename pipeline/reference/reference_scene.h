#pragma once
// A scene that rays can be shot into (Embree 3, reproducible: SSE4.2 code on every machine, robust
// intersection).
#include <cstdint>
#include <functional>
#include <memory>

#include "pipeline/reference/camera_rays.h"
#include "pipeline/scene/scene.h"

namespace hwsim::pipeline {

struct Visibility {
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  std::uint32_t instance = kNone;  ///< index into Scene::instances; kNone: nothing was hit
  std::uint32_t part = 0;          ///< index into Mesh::parts
  std::uint32_t primitive = 0;     ///< triangle of the mesh: Mesh::indices[3 * primitive] is its first index
  float t = 0.0f;                  ///< in lengths of the ray's direction
  float u = 0.0f, v = 0.0f;        ///< weights of the second and the third vertex
  bool front_face = true;
  explicit operator bool() const { return instance != kNone; }
};

/// What is needed to know the alpha of a point on a surface whose AlphaMode is mask.
struct AlphaQuery {
  int material = 0;
  glm::vec2 uv0{0.0f}, uv1{0.0f};
  float vertex_alpha = 1.0f;
};
/// Called from several threads at a time.
using AlphaLookup = std::function<float(const AlphaQuery&)>;

/// A point on a surface, as shading needs it. World space, vectors of unit length.
struct SurfaceHit {
  glm::vec3 position{0.0f};
  glm::vec3 normal{0.0f};            ///< interpolated; on the back of a double-sided surface turned around
  glm::vec3 geometric_normal{0.0f};  ///< the triangle's, on the viewer's side
  glm::vec4 tangent{0.0f};           ///< w: handedness; 0 where the mesh has none
  glm::vec2 uv0{0.0f}, uv1{0.0f};
  glm::vec4 color{1.0f};
  glm::vec3 to_viewer{0.0f};
  glm::vec2 uv0_dx{0.0f}, uv0_dy{0.0f}, uv1_dx{0.0f}, uv1_dy{0.0f};  ///< change from a pixel to the next
  float view_distance_m = 0.0f;                                      ///< along the optical axis
  int material = 0;
  std::uint32_t instance = 0, primitive = 0;
  bool front_face = true;
};

/// Immutable; every member may be called from several threads. The scene must live as long.
///
/// Camera rays meet what the rasterizer draws: back faces of single-sided materials and points of mask
/// materials with alpha < cutoff let them pass. A front face is counter-clockwise in the mesh's space, also
/// in mirrored instances.
class ReferenceScene {
 public:
  /// Without `alpha`, mask materials have their base color's alpha times the vertices'. Throws
  /// std::runtime_error when Embree cannot start or runs out of memory.
  explicit ReferenceScene(const Scene& scene, AlphaLookup alpha = {}, int jobs = 1);
  ~ReferenceScene();
  ReferenceScene(const ReferenceScene&) = delete;
  ReferenceScene& operator=(const ReferenceScene&) = delete;

  const Scene& scene() const;
  /// The nearest surface. `with_blend`: materials of AlphaMode::blend are surfaces too.
  Visibility trace(const Ray& ray, bool with_blend = true) const;
  SurfaceHit surface(const Visibility& hit, const PixelRay& pixel) const;

  /// Whether nothing casts a shadow from one point to the other. Both sides of a surface cast one, blended
  /// ones none.
  bool visible(glm::vec3 from, glm::vec3 to) const;
  /// Likewise to infinity along a direction.
  bool sees_sky(glm::vec3 from, glm::vec3 direction) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hwsim::pipeline
