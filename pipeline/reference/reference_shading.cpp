#include "pipeline/reference/reference_shading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "pipeline/emulate/material_views.h"
#include "pipeline/reference/reference.h"
#include "pipeline/shade/surface-inl.h"
#include "pipeline/shade/texel_quad-inl.h"
#include "pipeline/simd/scalar_lane-inl.h"
#include "pipeline/texture/texture_sampler-inl.h"

namespace hwsim::pipeline {
namespace {
using namespace HWY_NAMESPACE;  // the scalar lane of the static target

using ScalarSampler = TextureSampler<ScalarF, ScalarI, ScalarM>;

// The light that casts shadows, and what stands in its way: rays, or the map of the frame that is compared.
struct ShadowCaster {
  const ReferenceScene* occluders = nullptr;
  glm::vec3 to_light{0.0f};
  const Image* map = nullptr;
};

// What the shading templates call, for one point on a surface.
class ScalarShading {
 public:
  using F = ScalarF;
  using I = ScalarI;
  using M = ScalarM;

  ScalarShading(const SurfaceHit& hit, const MaterialView& material, const ShadowCaster& caster)
      : hit_(hit), material_(material), caster_(caster) {
    // SurfaceHit turns the normal of a back face around, and so does facing(): once is enough.
    const glm::vec3 normal = hit.front_face ? hit.normal : -hit.normal;
    put(SurfaceVaryings::kNormal, normal);
    put(SurfaceVaryings::kPosition, hit.position);
    put(SurfaceVaryings::kTangent, glm::vec3(hit.tangent));
    put(SurfaceVaryings::kColor, glm::vec3(hit.color));
    varyings_[SurfaceVaryings::kUv0] = hit.uv0.x;
    varyings_[SurfaceVaryings::kUv0 + 1] = hit.uv0.y;
    varyings_[SurfaceVaryings::kUv1] = hit.uv1.x;
    varyings_[SurfaceVaryings::kUv1 + 1] = hit.uv1.y;
    varyings_[SurfaceVaryings::kTangent + 3] = hit.tangent.w;
    varyings_[SurfaceVaryings::kColor + 3] = hit.color.w;
  }

  M valid() const { return {true}; }
  const MaterialView& material() const { return material_; }
  F attr(int k) const { return varyings_[static_cast<std::size_t>(k)]; }
  Vec3<F> attr3(int k) const { return {attr(k), attr(k + 1), attr(k + 2)}; }
  F facing() const { return hit_.front_face ? 1.0f : -1.0f; }

  Vec4<F> sample_texture(const TextureView* texture, int uv_at) const {
    std::uint64_t probes = 0;
    const bool second = uv_at == SurfaceVaryings::kUv1;
    const glm::vec2 uv = second ? hit_.uv1 : hit_.uv0, dx = second ? hit_.uv1_dx : hit_.uv0_dx,
                    dy = second ? hit_.uv1_dy : hit_.uv0_dy;
    return ScalarSampler(*texture, nullptr, valid()).sample(uv.x, uv.y, dx.x, dx.y, dy.x, dy.y, probes);
  }

  template <class Body>
  void branch(int, M mask, Body&& body) {
    if (mask.v) body();
  }
  template <class Body>
  void uniform_branch(int, bool condition, Body&& body) {
    if (condition) body();
  }
  template <class Body>
  void loop(int, int count, M mask, Body&& body) {
    for (int i = 0; mask.v && i < count; ++i) body(i);
  }
  std::size_t loop_count(int count) const { return static_cast<std::size_t>(count); }

  bool has_shadow_map() const { return caster_.map != nullptr; }
  // The shadow map is the only image. Coordinates are clamped to it, as in a frame.
  F compare_image(int, F x, F y, F reference) const {
    const Image& map = *caster_.map;
    const auto texel = [&](int at_x, int at_y) {
      return F(map.at(std::clamp(at_x, 0, map.width - 1), std::clamp(at_y, 0, map.height - 1)).x);
    };
    return compare_bilinear<F, I>(x, y, reference, [&](I left, I top) {
      return TexelQuad<F>{texel(left.v, top.v), texel(left.v + 1, top.v), texel(left.v, top.v + 1),
                          texel(left.v + 1, top.v + 1)};
    });
  }

  // A light below the surface adds nothing: no ray is shot for it.
  F ray_visibility(glm::vec3 position, glm::vec3 normal) const {
    if (glm::dot(normal, caster_.to_light) <= 0.0f) return 0.0f;
    return caster_.occluders->sees_sky(position, caster_.to_light) ? 1.0f : 0.0f;
  }

 private:
  void put(int k, glm::vec3 v) {
    for (int i = 0; i < 3; ++i) varyings_[static_cast<std::size_t>(k + i)] = v[i];
  }

  const SurfaceHit& hit_;
  const MaterialView& material_;
  const ShadowCaster& caster_;
  std::array<float, SurfaceVaryings::kFull> varyings_{};
};

// light_surface finds this one by its argument (not const: as exact as the template), which is the frame's
// own where there is a map.
ScalarF shadow_visibility(ScalarShading& s, const LightingUniforms& lighting, const Vec3<ScalarF>& position,
                          const Vec3<ScalarF>& normal) {
  if (s.has_shadow_map())
    return HWY_NAMESPACE::shadow_visibility<ScalarShading, ScalarF>(s, lighting, position, normal);
  return s.ray_visibility({position.x.v, position.y.v, position.z.v}, {normal.x.v, normal.y.v, normal.z.v});
}

struct SceneMaterials {
  TextureStore textures;
  MaterialViews views;
  explicit SceneMaterials(const Scene& scene) : textures(scene), views(scene, textures) {}
};

AlphaLookup texture_alpha(std::shared_ptr<const SceneMaterials> materials) {
  return [materials = std::move(materials)](const AlphaQuery& query) {
    const MaterialView& material = materials->views.view(query.material);
    const float alpha = material.base_color[3] * query.vertex_alpha;
    const TextureView* texture = material.base_color_texture;
    if (texture == nullptr) return alpha;
    const glm::vec2 uv = texture->uv_set == 1 ? query.uv1 : query.uv0;
    std::uint64_t probes = 0;
    return alpha * ScalarSampler(*texture, nullptr, {true}).filter(uv.x, uv.y, 0.0f, probes).w.v;
  };
}

struct SceneShading {
  std::shared_ptr<const SceneMaterials> materials;
  LightingUniforms lighting;
  std::shared_ptr<const Image> shadow_map;
  glm::vec3 to_shadowed_light{0.0f};
  bool full_varyings;

  SceneShading(const Scene& scene, const GroundTruthOptions& options)
      : materials(std::make_shared<const SceneMaterials>(scene)),
        lighting(options.lighting
                     ? *options.lighting
                     : make_lighting(scene, scene.cameras.at(static_cast<std::size_t>(options.camera)))),
        shadow_map(options.shadow_map),
        full_varyings(needs_full_varyings(scene)) {
    const auto caster = std::find_if(lighting.directional.begin(), lighting.directional.end(),
                                     [](const DirectionalLight& light) { return light.shadowed; });
    const bool casts = options.shadows && caster != lighting.directional.end();
    lighting.shadow_slot = casts ? 0 : -1;
    if (casts) to_shadowed_light = caster->to_light;
  }

  glm::vec4 shade(const SurfaceHit& hit, const ReferenceScene& occluders) const {
    const ShadowCaster caster{&occluders, to_shadowed_light, shadow_map.get()};
    ScalarShading s(hit, materials->views.view(hit.material), caster);
    const MaterialSample<ScalarF> sample = sample_material(s, full_varyings);
    const Surface<ScalarF> surface = make_surface(sample, s.attr3(SurfaceVaryings::kPosition), lighting.eye);
    const Vec3<ScalarF> color =
        occlude_ambient(s, lighting, surface, light_surface(s, lighting, surface, s.valid()));
    return {color.x.v, color.y.v, color.z.v, sample.base.w.v};
  }
};

ReferenceOptions reference_options(const GroundTruthOptions& options) {
  ReferenceOptions reference;
  reference.width = options.width;
  reference.height = options.height;
  reference.camera = options.camera;
  reference.samples = options.samples;
  reference.offsets_px = options.offsets_px;
  reference.jobs = options.jobs;
  reference.largest_sample_value = 1.0f;
  const float samples = static_cast<float>(std::max(sample_count(reference), 1));
  reference.footprint_scale =
      options.footprint_scale > 0.0f ? options.footprint_scale : 1.0f / std::sqrt(samples);
  reference.progress = options.progress;
  return reference;
}

}  // namespace

AlphaLookup texture_alpha(const Scene& scene) {
  return texture_alpha(std::make_shared<const SceneMaterials>(scene));
}

Image render_ground_truth(const Scene& scene, const GroundTruthOptions& options) {
  const SceneShading shading(scene, options);
  const ReferenceScene traced(scene, texture_alpha(shading.materials), options.jobs);
  return render_reference(traced, reference_options(options),
                          [&](std::span<const SurfaceHit> hits, std::span<glm::vec4> colors) {
                            for (std::size_t i = 0; i < hits.size(); ++i)
                              colors[i] = shading.shade(hits[i], traced);
                          });
}

}  // namespace hwsim::pipeline
