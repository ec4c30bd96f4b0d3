// Shading models (docs/techniques/conventions.md#shading-models) and direct lighting, for every lane type:
// the emulator's registers, the counting type, and the scalar of the ray-traced reference. Per-target include
// guard, see simd/lanes-inl.h.
#include <hwy/highway.h>

#include "pipeline/shade/lighting.h"
#include "pipeline/simd/codec-inl.h"
#include "pipeline/simd/transcendental-inl.h"
#include "pipeline/simd/vec-inl.h"

#if defined(HWSIM_SHADE_LIGHTING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SHADE_LIGHTING_INL_H_
#undef HWSIM_SHADE_LIGHTING_INL_H_
#else
#define HWSIM_SHADE_LIGHTING_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// What lighting needs to know of a point on a surface.
template <class F>
struct Surface {
  Vec3<F> position, normal, to_eye;
  Vec3<F> albedo;    ///< diffuse reflectance
  Vec3<F> specular;  ///< k_s, reflectance at normal incidence
  F exponent;        ///< Blinn-Phong
  F alpha;           ///< GGX, roughness squared
  Vec3<F> emissive;
};

template <class F>
Vec3<F> broadcast(const glm::vec3& v) {
  return {F(v.x), F(v.y), F(v.z)};
}

/// base color and metallic-roughness to the models' parameters; alpha is kept above 0.03 (exponent below
/// 2200).
template <class F>
void set_roughness(F roughness, Surface<F>& surface) {
  const F alpha = max(roughness * roughness, F(0.03f));
  surface.alpha = alpha;
  surface.exponent = max(F(2.0f) / (alpha * alpha) - F(2.0f), F(0.0f));
}
template <class F>
void set_material(Vec3<F> base, F metallic, F roughness, Surface<F>& surface) {
  set_roughness(roughness, surface);
  surface.albedo = base * (F(1.0f) - metallic);
  const F dielectric = F(0.04f) * (F(1.0f) - metallic);
  surface.specular = base * metallic + Vec3<F>{dielectric, dielectric, dielectric};
}

/// E * (rho + k_s (s+8)/(8 pi) (n.h)^s) * (n.l), both gated by the light being above the surface.
template <class F>
Vec3<F> blinn_phong(const Surface<F>& s, const Vec3<F>& l, F n_dot_l) {
  const Vec3<F> h = normalize(l + s.to_eye);
  const F n_dot_h = max(dot(s.normal, h), F(0.0f));
  const F lobe = (s.exponent + F(8.0f)) * F(0.0397887358f) * pow(n_dot_h, s.exponent);
  return s.albedo * n_dot_l + s.specular * select(n_dot_l > F(0.0f), lobe, F(0.0f));
}

/// E * (rho (n.l) + k_s (r.v)^s), the second gated as above; not normalized, as the papers of its time have
/// it.
template <class F>
Vec3<F> phong(const Surface<F>& s, const Vec3<F>& l, F n_dot_l) {
  const Vec3<F> r = s.normal * (F(2.0f) * dot(s.normal, l)) - l;
  const F lobe = pow(max(dot(r, s.to_eye), F(0.0f)), s.exponent);
  return s.albedo * n_dot_l + s.specular * select(n_dot_l > F(0.0f), lobe, F(0.0f));
}

/// Smith separable G2, Schlick F; no 1/pi on the diffuse part (the lights' scale,
/// docs/techniques/conventions.md#shading-models), so pi on the other.
template <class F>
Vec3<F> ggx(const Surface<F>& s, const Vec3<F>& l, F n_dot_l) {
  const Vec3<F> h = normalize(l + s.to_eye);
  const F n_dot_v = max(dot(s.normal, s.to_eye), F(1e-4f));
  const F n_dot_h = max(dot(s.normal, h), F(0.0f)), v_dot_h = max(dot(s.to_eye, h), F(0.0f));
  const F a2 = s.alpha * s.alpha;
  const F d = n_dot_h * n_dot_h * (a2 - F(1.0f)) + F(1.0f);
  const F ndf = a2 / max(d * d, F(1e-12f));  // times 1/pi, cancelled
  const auto g1 = [&](F c) HWY_ATTR { return F(2.0f) * c / (c + sqrt(a2 + (F(1.0f) - a2) * c * c)); };
  const F n_dot_l_safe = max(n_dot_l, F(1e-4f));
  const F visibility = g1(n_dot_v) * g1(n_dot_l_safe) / (F(4.0f) * n_dot_v * n_dot_l_safe);
  const F m = F(1.0f) - v_dot_h;
  const F m2 = m * m;
  const F schlick = m2 * m2 * m;
  const Vec3<F> one = {F(1.0f), F(1.0f), F(1.0f)};
  const Vec3<F> fresnel = s.specular + (one - s.specular) * schlick;
  return (s.albedo + fresnel * (ndf * visibility)) * n_dot_l;
}

template <class F>
Vec3<F> reflect_light(const Surface<F>& s, const Vec3<F>& l, ShadingModel model) {
  const F n_dot_l = max(dot(s.normal, l), F(0.0f));
  switch (model) {
    case ShadingModel::ggx:
      return ggx(s, l, n_dot_l);
    case ShadingModel::phong:
      return phong(s, l, n_dot_l);
    default:
      return blinn_phong(s, l, n_dot_l);
  }
}

/// 1/d^2 windowed to zero at the range (Karis 2013); d: from the surface to the light, whose unit direction
/// `l` receives.
template <class F>
F distance_attenuation(const Vec3<F>& d, F inv_range2, Vec3<F>& l) {
  const F d2 = max(dot(d, d), F(1e-4f));
  const F inv_d = rsqrt(d2);
  l = d * inv_d;
  const F q = d2 * inv_range2;
  const F window = max(F(1.0f) - q * q, F(0.0f));
  return window * window * inv_d * inv_d;
}
/// What a spot's cone leaves of it.
template <class F>
F cone_attenuated(F attenuation, const Vec3<F>& l, const Vec3<F>& axis, F cos_outer, F inv_cos_span) {
  const F c = F(0.0f) - dot(l, axis);
  const F cone = saturate((c - cos_outer) * inv_cos_span);
  return attenuation * cone * cone;
}

/// Distance and cone of a light that is the same for all lanes.
template <class F>
F point_attenuation(const PointLight& light, const Vec3<F>& position, Vec3<F>& l) {
  const F attenuation = distance_attenuation(broadcast<F>(light.position) - position, F(light.inv_range2), l);
  if (light.cos_outer <= -1.5f) return attenuation;
  return cone_attenuated(attenuation, l, broadcast<F>(light.axis), F(light.cos_outer), F(light.inv_cos_span));
}

/// Block numbers of lighting within a shader's blocks (batch/program.h); materials use 1 to 5.
enum LightingBlock : int { kShadowBlock = 6, kDirectionalBlock = 7, kPointBlock = 8, kPointInRangeBlock = 9 };

/// Share of the light that reaches a point: a comparison sampler's four taps, weighed.
template <class S, class F>
F shadow_visibility(S& s, const LightingUniforms& u, const Vec3<F>& position, const Vec3<F>& normal) {
  const Vec3<F> p = position + normal * F(u.shadow_offset_m);
  const glm::mat4& m = u.shadow_from_world;
  const auto row = [&](int r) HWY_ATTR {
    return F(m[0][r]) * p.x + F(m[1][r]) * p.y + F(m[2][r]) * p.z + F(m[3][r]);
  };
  return s.compare_image(u.shadow_slot, row(0), row(1), row(2) - F(u.shadow_bias));
}

/// body(unit direction to the light, its color as it arrives) for directional lights. `mask`: lanes that are
/// lit at all.
template <class S, class F, class M, class Body>
void for_each_directional(S& s, const LightingUniforms& u, const Surface<F>& surface, M mask, Body&& body) {
  s.loop(kDirectionalBlock, u.directional_count, mask, [&](int i) HWY_ATTR {
    const DirectionalLight& light = u.directional[static_cast<std::size_t>(i)];
    F visible(1.0f);
    s.uniform_branch(kShadowBlock, light.shadowed && u.shadow_slot >= 0,
                     [&]() HWY_ATTR { visible = shadow_visibility(s, u, surface.position, surface.normal); });
    body(broadcast<F>(light.to_light), broadcast<F>(light.color) * visible);
  });
}

/// The same for directional lights and the given point lights.
template <class S, class F, class M, class Body>
void for_each_light(S& s, const LightingUniforms& u, std::span<const PointLight> points,
                    const Surface<F>& surface, M mask, Body&& body) {
  for_each_directional(s, u, surface, mask, body);
  s.loop(kPointBlock, static_cast<int>(points.size()), mask, [&](int i) HWY_ATTR {
    const PointLight& light = points[static_cast<std::size_t>(i)];
    Vec3<F> l;
    const F attenuation = point_attenuation(light, surface.position, l);
    s.branch(kPointInRangeBlock, mask & (attenuation > F(0.0f)),
             [&]() HWY_ATTR { body(l, broadcast<F>(light.color) * attenuation); });
  });
}

/// What a surface reflects of the ambient light.
template <class F>
Vec3<F> ambient_light(const LightingUniforms& u, const Surface<F>& surface) {
  const Vec3<F> ambient = broadcast<F>(u.ambient);
  if (u.extended) return (surface.albedo + surface.specular) * ambient;
  return surface.albedo * ambient;
}

/// Ambient, emissive, directional lights and the given point lights.
template <class S, class F, class M>
Vec3<F> light_surface(S& s, const LightingUniforms& u, std::span<const PointLight> points,
                      const Surface<F>& surface, M mask) {
  Vec3<F> sum = surface.emissive + ambient_light(u, surface);
  for_each_light(s, u, points, surface, mask, [&](const Vec3<F>& l, const Vec3<F>& light) HWY_ATTR {
    sum = sum + reflect_light(surface, l, u.model) * light;
  });
  return sum;
}

template <class S, class F, class M>
Vec3<F> light_surface(S& s, const LightingUniforms& u, const Surface<F>& surface, M mask) {
  // Without lights the vector still holds one, for the counting context.
  return light_surface(s, u, std::span(u.points.data(), s.loop_count(u.point_count)), surface, mask);
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
