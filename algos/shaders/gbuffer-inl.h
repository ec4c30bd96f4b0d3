// Encoding and decoding of the G-buffer, shared by the passes that write and read it.
// Per-target include guard, see shade/lanes-inl.h.
#include <hwy/highway.h>
#include "algos/shaders/deferred.h"
#include "pipeline/shade/surface-inl.h"
#if defined(HWSIM_ALGOS_SHADERS_GBUFFER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_SHADERS_GBUFFER_INL_H_
#undef HWSIM_ALGOS_SHADERS_GBUFFER_INL_H_
#else
#define HWSIM_ALGOS_SHADERS_GBUFFER_INL_H_
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

template <class S>
GBufferSample<typename S::F, typename S::M> read_gbuffer(S& s, const DeferredUniforms& u, typename S::I x,
                                                         typename S::I y, typename S::I sample,
                                                         typename S::F ox, typename S::F oy) {
  using F = typename S::F;
  const auto shape = s.load_image(kNormalSlot, x, y, sample);
  const auto base = s.load_image(kAlbedoSlot, x, y, sample);
  const F z = s.load_image(kDepthSlot, x, y, sample).x;
  GBufferSample<F, typename S::M> out{{}, z < F(1.0f)};
  lanes::Surface<F>& surface = out.surface;
  surface.position = unproject<S>(u.world_from_clip, u, x, y, ox, oy, z);
  surface.normal = decode_normal(shape.x, shape.y);
  surface.to_eye = normalize(lanes::broadcast<F>(u.lighting.eye) - surface.position);
  lanes::set_material(lanes::Vec3<F>{base.x, base.y, base.z}, base.w, shape.z, surface);
  surface.emissive = {shape.w, shape.w, shape.w};
  return out;
}

/// View-space z of a sample (negative in front of the camera).
template <class S>
typename S::F view_z(S& s, const DeferredUniforms& u, typename S::I x, typename S::I y,
                     typename S::I sample) {
  using F = typename S::F;
  const F z = s.load_image(kDepthSlot, x, y, sample).x;
  const glm::mat4& m = u.view_from_clip;  // rows 2 and 3 have no x and y in the cameras' projections
  return (F(m[2][2]) * z + F(m[3][2])) / (F(m[2][3]) * z + F(m[3][3]));
}

/// Lauritzen 2010: a sample whose depth or normal departs from sample 0's.
template <class S>
typename S::M is_complex(S& s, const DeferredUniforms& u, int loop_block, typename S::I x, typename S::I y) {
  using F = typename S::F;
  using I = typename S::I;
  const auto first = s.load_image(kNormalSlot, x, y, I(0));
  const auto gradient = s.load_image(kGradientSlot, x, y, I(0));
  const auto n0 = decode_normal(first.x, first.y);
  const F z0 = view_z(s, u, x, y, I(0));
  const F span = abs(gradient.x) + abs(gradient.y);
  auto complex = F(1.0f) < F(0.0f);
  s.loop(loop_block, u.samples - 1, s.valid(), [&](int i) HWY_ATTR {
    const auto shape = s.load_image(kNormalSlot, x, y, I(i + 1));
    const F dz = abs(view_z(s, u, x, y, I(i + 1)) - z0);
    const F cosine = dot(decode_normal(shape.x, shape.y), n0);
    complex = complex | (dz > span) | (cosine < F(u.normal_dot_min));
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
