// From interpolated attributes and a material to a Surface: shared by forward shading and G-buffer passes.
// Per-target include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>
#include "pipeline/batch/fragment_batch.h"
#include "pipeline/shade/lighting-inl.h"
#include "pipeline/shade/mesh_vertex.h"
#if defined(HWSIM_SHADE_SURFACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SHADE_SURFACE_INL_H_
#undef HWSIM_SHADE_SURFACE_INL_H_
#else
#define HWSIM_SHADE_SURFACE_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

enum MaterialBlock : int {
  kBaseTextureBlock = 1,
  kMetalRoughTextureBlock = 2,
  kNormalTextureBlock = 3,
  kEmissiveTextureBlock = 4,
  kVertexColorBlock = 5,
  kOcclusionTextureBlock = 11  // 6 to 9 are the lights', 10 a tile's
};

/// Where a texture's coordinates lie among the attribute scalars.
inline int uv_of(const TextureView* texture) {
  return texture != nullptr && texture->uv_set == 1 ? SurfaceVaryings::kUv1 : SurfaceVaryings::kUv0;
}

template <class F>
struct MaterialSample {
  Vec4<F> base;
  F metallic, roughness;
  Vec3<F> emissive;
  Vec3<F> normal;  ///< unit length, toward the viewer on double-sided materials
};

/// The base color's alpha alone, at attribute scalars (uv, uv + 1): alpha-tested depth passes.
template <class S>
typename S::F sample_alpha(S& s, int uv) {
  using F = typename S::F;
  const MaterialView& m = s.material();
  F alpha(m.base_color[3]);
  s.uniform_branch(kBaseTextureBlock, m.base_color_texture != nullptr,
                   [&]() HWY_ATTR { alpha = alpha * s.sample_texture_alpha(m.base_color_texture, uv); });
  return alpha;
}

template <class S>
Vec3<typename S::F> shading_normal(S& s, bool full_varyings) {
  using F = typename S::F;
  using V = SurfaceVaryings;
  const MaterialView& m = s.material();
  Vec3<F> n = normalize(s.attr3(V::kNormal));
  s.uniform_branch(kNormalTextureBlock, m.normal_texture != nullptr && full_varyings, [&]() HWY_ATTR {
    const Vec4<F> texel = s.sample_texture(m.normal_texture, uv_of(m.normal_texture));
    const F scale(m.normal_scale);
    const Vec3<F> t = s.attr3(V::kTangent);
    const Vec3<F> tangent = normalize(t - n * dot(n, t));
    const Vec3<F> bitangent = cross(n, tangent) * s.attr(V::kTangent + 3);
    const F x = (texel.x * F(2.0f) - F(1.0f)) * scale, y = (texel.y * F(2.0f) - F(1.0f)) * scale;
    const F z = texel.z * F(2.0f) - F(1.0f);
    n = normalize(tangent * x + bitangent * y + n * z);
  });
  // A back face of a double-sided material shows its other side.
  return n * s.facing();
}

/// An unlit surface is black and shines in its base color: no light changes that, ambient light neither.
template <class F>
void show_unlit(MaterialSample<F>& m) {
  m.emissive = {m.base.x, m.base.y, m.base.z};
  m.base = {F(0.0f), F(0.0f), F(0.0f), m.base.w};
  m.metallic = F(1.0f);
}

template <class S>
MaterialSample<typename S::F> sample_material(S& s, bool full_varyings) {
  using F = typename S::F;
  using V = SurfaceVaryings;
  const MaterialView& m = s.material();
  MaterialSample<F> out;
  out.base = {F(m.base_color[0]), F(m.base_color[1]), F(m.base_color[2]), F(m.base_color[3])};
  out.metallic = F(m.metallic);
  out.roughness = F(m.roughness);
  out.emissive = {F(m.emissive[0]), F(m.emissive[1]), F(m.emissive[2])};
  s.uniform_branch(kBaseTextureBlock, m.base_color_texture != nullptr, [&]() HWY_ATTR {
    const Vec4<F> texel = s.sample_texture(m.base_color_texture, uv_of(m.base_color_texture));
    out.base = {out.base.x * texel.x, out.base.y * texel.y, out.base.z * texel.z, out.base.w * texel.w};
  });
  s.uniform_branch(kMetalRoughTextureBlock, m.metallic_roughness_texture != nullptr, [&]() HWY_ATTR {
    const Vec4<F> texel = s.sample_texture(m.metallic_roughness_texture, uv_of(m.metallic_roughness_texture));
    out.roughness = out.roughness * texel.y;
    out.metallic = out.metallic * texel.z;
  });
  s.uniform_branch(kEmissiveTextureBlock, m.emissive_texture != nullptr, [&]() HWY_ATTR {
    const Vec4<F> texel = s.sample_texture(m.emissive_texture, uv_of(m.emissive_texture));
    out.emissive = out.emissive * Vec3<F>{texel.x, texel.y, texel.z};
  });
  s.uniform_branch(kVertexColorBlock, full_varyings && m.has_colors, [&]() HWY_ATTR {
    out.base = {out.base.x * s.attr(V::kColor), out.base.y * s.attr(V::kColor + 1),
                out.base.z * s.attr(V::kColor + 2), out.base.w * s.attr(V::kColor + 3)};
  });
  out.normal = shading_normal(s, full_varyings);
  if (m.unlit) show_unlit(out);
  return out;
}

template <class F>
Surface<F> make_surface(const MaterialSample<F>& m, const Vec3<F>& position, const glm::vec3& eye) {
  Surface<F> surface;
  surface.position = position;
  surface.normal = m.normal;
  surface.to_eye = normalize(broadcast<F>(eye) - position);
  set_material(Vec3<F>{m.base.x, m.base.y, m.base.z}, m.metallic, m.roughness, surface);
  surface.emissive = m.emissive;
  return surface;
}

/// The lanes of `mask` that lights are worth summing for: none of an unlit material.
template <class S>
typename S::M lights_reach(const S& s, typename S::M mask) {
  using F = typename S::F;
  return s.material().unlit ? mask & (F(1.0f) < F(0.0f)) : mask;
}

/// Takes away the ambient light that an occlusion texture keeps off (glTF 2.0, 3.9.3: direct light stays).
template <class S>
Vec3<typename S::F> occlude_ambient(S& s, const LightingUniforms& u, const Surface<typename S::F>& surface,
                                    Vec3<typename S::F> color) {
  using F = typename S::F;
  const MaterialView& m = s.material();
  s.uniform_branch(kOcclusionTextureBlock, m.occlusion_texture != nullptr, [&]() HWY_ATTR {
    const F open = s.sample_texture(m.occlusion_texture, uv_of(m.occlusion_texture)).x;
    const F lost = (F(1.0f) - open) * F(m.occlusion_strength);
    color = color - ambient_light(u, surface) * lost;
  });
  return color;
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
