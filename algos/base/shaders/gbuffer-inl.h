// Encoding and decoding of the G-buffer, shared by the passes that write and read it.
// Per-target include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>
#include "algos/base/shaders/gbuffer.h"
#include "pipeline/shade/surface-inl.h"
#if defined(HWSIM_ALGOS_BASE_SHADERS_GBUFFER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_BASE_SHADERS_GBUFFER_INL_H_
#undef HWSIM_ALGOS_BASE_SHADERS_GBUFFER_INL_H_
#else
#define HWSIM_ALGOS_BASE_SHADERS_GBUFFER_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

namespace lanes = pipeline::HWY_NAMESPACE;

template <class F>
F copy_sign_of(F magnitude, F sign) {
  return select(sign < F(0.0f), F(0.0f) - magnitude, magnitude);
}

/// Unit vector to the octahedron's net, [-1, 1]^2 (Cigolle et al. 2014).
template <class F>
lanes::Vec2<F> encode_normal(const lanes::Vec3<F>& n) {
  const F scale = F(1.0f) / max(abs(n.x) + abs(n.y) + abs(n.z), F(1e-20f));
  const F x = n.x * scale, y = n.y * scale;
  const auto lower = n.z < F(0.0f);
  return {select(lower, copy_sign_of(F(1.0f) - abs(y), x), x),
          select(lower, copy_sign_of(F(1.0f) - abs(x), y), y)};
}

template <class F>
lanes::Vec3<F> decode_normal(F x, F y) {
  const F z = F(1.0f) - abs(x) - abs(y);
  const F fold = max(F(0.0f) - z, F(0.0f));
  return normalize(lanes::Vec3<F>{x - copy_sign_of(fold, x), y - copy_sign_of(fold, y), z});
}

/// Relative luminance of linear sRGB.
template <class F>
F luminance(const lanes::Vec3<F>& c) {
  return c.x * F(0.2126f) + c.y * F(0.7152f) + c.z * F(0.0722f);
}

/// Below this roughness the shading models do not change (lanes::set_material), so a stored one is never 0:
/// that marks background and slots that nothing was written to.
inline constexpr float kLeastRoughness = 0.0625f;
/// Marks an unlit surface, whose base color stands where a lit one's does: below every lit surface's
/// roughness, 0 in eight bits, but positive.
inline constexpr float kUnlitRoughness = 0x1p-10f, kUnlitBelow = 0.03f;

/// Attributes of a fragment on their way into a G-buffer.
template <class F>
struct GBufferValues {
  lanes::Vec3<F> position, normal, base, emissive;
  F metallic, roughness;
  lanes::Vec2<F> gradient;  ///< change of view-space depth for a pixel
  F alpha = F(1.0f);        ///< coverage, where alpha is no test
  float least_roughness = kLeastRoughness;
};

/// Puts an unlit material's color where base color is kept, with its mark. Only in extended shaders.
template <class S, class F>
void mark_unlit(const S& s, bool extended, GBufferValues<F>& v) {
  if (!extended) return;
  if (!s.material().unlit) {
    v.roughness = max(v.roughness, F(kLeastRoughness));
    return;
  }
  v.base = v.emissive;
  v.emissive = {F(0.0f), F(0.0f), F(0.0f)};
  v.metallic = F(0.0f);
  v.roughness = F(kUnlitRoughness);
  v.least_roughness = kUnlitRoughness;
}

/// The opposite of mark_unlit, on what was read back.
template <class F>
void show_marked(const pipeline::LightingUniforms& u, F roughness, lanes::Surface<F>& surface) {
  if (!u.extended) return;
  const auto unlit = roughness < F(kUnlitBelow);
  const lanes::Vec3<F> black = {F(0.0f), F(0.0f), F(0.0f)};
  surface.emissive = select(unlit, surface.albedo, surface.emissive);
  surface.albedo = select(unlit, black, surface.albedo);
  surface.specular = select(unlit, black, surface.specular);
}

template <GBufferEncoding kEncoding, class S, class F>
void write_gbuffer(S& s, const GBufferValues<F>& v) {
  const auto n = encode_normal(v.normal);
  if constexpr (kEncoding == GBufferEncoding::gradients) {
    s.output(0, {n.x, n.y, v.roughness, luminance(v.emissive)});
    s.output(1, {v.base.x, v.base.y, v.base.z, v.metallic});
    s.output(2, {v.gradient.x, v.gradient.y, F(0.0f), F(0.0f)});
  } else if constexpr (kEncoding == GBufferEncoding::record) {
    s.output(0, {v.position.x, v.position.y, v.position.z, max(v.roughness, F(v.least_roughness))});
    s.output(1, {n.x, n.y, F(0.0f), F(0.0f)});
    s.output(2, {v.base.x, v.base.y, v.base.z, v.metallic});
    s.output(3, {v.emissive.x, v.emissive.y, v.emissive.z, F(1.0f)});
    s.output(4, {v.gradient.x, v.gradient.y, F(0.0f), F(0.0f)});
  } else if constexpr (kEncoding == GBufferEncoding::split) {
    s.output(0, {n.x, n.y, F(0.0f), F(0.0f)});
    s.output(1, {v.roughness, luminance(v.emissive), F(0.0f), F(0.0f)});
    s.output(2, {v.base.x, v.base.y, v.base.z, v.metallic});
    s.output(3, {v.gradient.x, v.gradient.y, F(0.0f), F(0.0f)});
  } else {
    lanes::Surface<F> surface;
    lanes::set_material(v.base, v.metallic, v.roughness, surface);
    s.output(0, {n.x, n.y, F(0.0f), v.alpha});  // the target has no alpha: it is there for coverage alone
    s.output(1, {surface.albedo.x, surface.albedo.y, surface.albedo.z, v.roughness});
    s.output(2, {surface.specular.x, surface.specular.y, surface.specular.z, luminance(v.emissive)});
  }
}

/// What a lighting pass knows of one sample.
template <class F, class M>
struct GBufferSample {
  lanes::Surface<F> surface;
  M covered;  ///< not background
};

/// World position of sample (ox, oy pixels from the pixel's center) at depth z.
template <class S, class F, class I>
lanes::Vec3<F> unproject(const glm::mat4& m, const DeferredUniforms& u, I x, I y, F ox, F oy, F z) {
  const F ndc_x = (to_float(x) + F(0.5f) + ox) * F(2.0f / static_cast<float>(u.width)) - F(1.0f);
  const F ndc_y = F(1.0f) - (to_float(y) + F(0.5f) + oy) * F(2.0f / static_cast<float>(u.height));
  const auto row = [&](int r) HWY_ATTR {
    return F(m[0][r]) * ndc_x + F(m[1][r]) * ndc_y + F(m[2][r]) * z + F(m[3][r]);
  };
  const F inv_w = F(1.0f) / row(3);
  return {row(0) * inv_w, row(1) * inv_w, row(2) * inv_w};
}

template <GBufferEncoding kEncoding, class S>
GBufferSample<typename S::F, typename S::M> read_gbuffer(S& s, const DeferredUniforms& u, typename S::I x,
                                                         typename S::I y, typename S::I sample,
                                                         typename S::F ox, typename S::F oy) {
  using F = typename S::F;
  GBufferSample<F, typename S::M> out{};
  lanes::Surface<F>& surface = out.surface;
  const auto first = s.load_image(0, x, y, sample), second = s.load_image(1, x, y, sample);
  if constexpr (kEncoding == GBufferEncoding::record) {
    const auto base = s.load_image(2, x, y, sample), emissive = s.load_image(3, x, y, sample);
    out.covered = first.w > F(0.0f);
    surface.position = {first.x, first.y, first.z};
    surface.normal = decode_normal(second.x, second.y);
    lanes::set_material(lanes::Vec3<F>{base.x, base.y, base.z}, base.w, first.w, surface);
    surface.emissive = {emissive.x, emissive.y, emissive.z};
    show_marked(u.lighting, first.w, surface);
  } else {
    const F z = s.load_image(depth_slot(kEncoding), x, y, sample).x;
    out.covered = z < F(1.0f);
    surface.position = unproject<S>(u.world_from_clip, u, x, y, ox, oy, z);
    surface.normal = decode_normal(first.x, first.y);
    F emissive = first.w, roughness = second.w;
    if constexpr (kEncoding == GBufferEncoding::gradients) {
      roughness = first.z;
      lanes::set_material(lanes::Vec3<F>{second.x, second.y, second.z}, second.w, roughness, surface);
    } else if constexpr (kEncoding == GBufferEncoding::split) {
      const auto base = s.load_image(2, x, y, sample);
      roughness = second.x;
      lanes::set_material(lanes::Vec3<F>{base.x, base.y, base.z}, base.w, roughness, surface);
      emissive = second.y;
    } else {
      const auto specular = s.load_image(2, x, y, sample);
      lanes::set_roughness(second.w, surface);
      surface.albedo = {second.x, second.y, second.z};
      surface.specular = {specular.x, specular.y, specular.z};
      emissive = specular.w;
    }
    surface.emissive = {emissive, emissive, emissive};
    show_marked(u.lighting, roughness, surface);
  }
  surface.to_eye = normalize(lanes::broadcast<F>(u.lighting.eye) - surface.position);
  return out;
}

/// View-space z of a sample (negative in front of the camera), and whether something was drawn there.
template <GBufferEncoding kEncoding, class S>
typename S::F view_z(S& s, const DeferredUniforms& u, typename S::I x, typename S::I y, typename S::I sample,
                     typename S::M& covered) {
  using F = typename S::F;
  if constexpr (kEncoding == GBufferEncoding::record) {
    const auto p = s.load_image(0, x, y, sample);
    const glm::mat4& v = u.view_from_world;
    covered = p.w > F(0.0f);
    const F z = F(v[0][2]) * p.x + F(v[1][2]) * p.y + F(v[2][2]) * p.z + F(v[3][2]);
    return select(covered, z, F(-1e30f));
  } else {
    const F z = s.load_image(depth_slot(kEncoding), x, y, sample).x;
    covered = z < F(1.0f);
    const glm::mat4& m = u.view_from_clip;  // rows 2 and 3 have no x and y in the cameras' projections
    return (F(m[2][2]) * z + F(m[3][2])) / (F(m[2][3]) * z + F(m[3][3]));
  }
}

/// How far view z of sample `base`'s surface goes over one pixel right and one down. Without stored
/// gradients: of the plane through the sample, met by the neighbors' rays (the position-difference form of
/// docs/techniques/deferred.md#simple-and-complex).
template <GBufferEncoding kEncoding, class S, class F>
F depth_span(S& s, const DeferredUniforms& u, typename S::I x, typename S::I y, const lanes::Vec3<F>& normal,
             F z, int base) {
  using I = typename S::I;
  if constexpr (kEncoding == GBufferEncoding::compact) {
    const glm::mat4 &v = u.view_from_world, &m = u.view_from_clip;
    const auto axis = [&](int r) HWY_ATTR {
      return F(v[0][r]) * normal.x + F(v[1][r]) * normal.y + F(v[2][r]) * normal.z;
    };
    const lanes::Vec3<F> n = {axis(0), axis(1), axis(2)};
    const bool perspective = m[2][3] != 0.0f;
    const F step_x(m[0][0] * 2.0f / static_cast<float>(u.width)),
        step_y(m[1][1] * 2.0f / static_cast<float>(u.height));
    if (!perspective) {
      const F slope = F(1.0f) / max(abs(n.z), F(1e-4f));
      return (abs(n.x) * abs(step_x) + abs(n.y) * abs(step_y)) * slope;
    }
    // The ray at unit distance; z(ray) = plane / (n . ray), differentiated.
    const F ndc_x = (to_float(x) + F(0.5f)) * F(2.0f / static_cast<float>(u.width)) - F(1.0f);
    const F ndc_y = F(1.0f) - (to_float(y) + F(0.5f)) * F(2.0f / static_cast<float>(u.height));
    const F facing = n.x * (ndc_x * F(m[0][0])) + n.y * (ndc_y * F(m[1][1])) - n.z;
    const F slope = abs(z) / max(abs(facing), F(1e-4f));
    return (abs(n.x) * abs(step_x) + abs(n.y) * abs(step_y)) * slope;
  } else {
    constexpr int kGradientSlot = kEncoding == GBufferEncoding::record  ? 4
                                  : kEncoding == GBufferEncoding::split ? 3
                                                                        : 2;
    const auto gradient = s.load_image(kGradientSlot, x, y, I(base));
    return abs(gradient.x) + abs(gradient.y);
  }
}

template <class F>
auto differs(const lanes::Vec4<F>& a, const lanes::Vec4<F>& b) {
  return (abs(a.x - b.x) + abs(a.y - b.y) + abs(a.z - b.z) + abs(a.w - b.w)) > F(0.0f);
}

/// Whether material attributes of a sample are not those of sample `base`.
template <GBufferEncoding kEncoding, class S>
typename S::M material_differs(S& s, typename S::I x, typename S::I y, typename S::I base,
                               typename S::I sample) {
  const auto at = [&](int slot) HWY_ATTR {
    const auto first = s.load_image(slot, x, y, base), own = s.load_image(slot, x, y, sample);
    return differs(own, first);
  };
  constexpr int kSlot = kEncoding == GBufferEncoding::gradients ? 0
                        : kEncoding == GBufferEncoding::record  ? 2
                                                                : 1;
  const auto second = at(kSlot + 1), first = at(kSlot);
  return first | second;
}

/// Lauritzen 2010: a sample whose depth or normal departs from that of sample `base`, the first of
/// `u.samples`. Uses two blocks from `loop_block` on.
template <GBufferEncoding kEncoding, class S>
typename S::M is_complex(S& s, const DeferredUniforms& u, int loop_block, typename S::I x, typename S::I y,
                         int base = 0) {
  using F = typename S::F;
  using I = typename S::I;
  constexpr int kNormalSlot = kEncoding == GBufferEncoding::record ? 1 : 0;
  const auto first = s.load_image(kNormalSlot, x, y, I(base));
  const auto n0 = decode_normal(first.x, first.y);
  typename S::M covered;
  const F z0 = view_z<kEncoding>(s, u, x, y, I(base), covered);
  const F span = depth_span<kEncoding>(s, u, x, y, n0, z0, base) * F(u.z_scale);
  auto complex = F(1.0f) < F(0.0f);
  s.loop(loop_block, u.samples - 1, s.valid(), [&](int i) HWY_ATTR {
    const auto shape = s.load_image(kNormalSlot, x, y, I(base + i + 1));
    typename S::M other;
    const F dz = abs(view_z<kEncoding>(s, u, x, y, I(base + i + 1), other) - z0);
    const F cosine = dot(decode_normal(shape.x, shape.y), n0);
    complex = complex | (dz > span) | (cosine < F(u.normal_dot_min));
    s.uniform_branch(loop_block + 1, u.compare_all, [&]() HWY_ATTR {
      complex = complex | material_differs<kEncoding>(s, x, y, I(base), I(base + i + 1));
    });
  });
  return complex;
}

/// The lit color of one sample; the background where nothing was drawn. Clamped as an 8-bit target would
/// clamp it.
template <class S>
lanes::Vec4<typename S::F> light_sample(S& s, const DeferredUniforms& u,
                                        std::span<const pipeline::PointLight> points,
                                        const GBufferSample<typename S::F, typename S::M>& sample,
                                        typename S::M mask) {
  using F = typename S::F;
  const auto lit = lanes::light_surface(s, u.lighting, points, sample.surface, mask & sample.covered);
  const auto color = select(sample.covered, lit, lanes::broadcast<F>(u.background));
  using lanes::saturate;
  return {saturate(color.x), saturate(color.y), saturate(color.z), F(1.0f)};
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
