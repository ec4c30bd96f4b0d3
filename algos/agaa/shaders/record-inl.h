// What passes 1 to 4 of AGAA share: the pixel's basis, normal codes, and records of aggregates.
// Per-target include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>
#include <type_traits>
#include "algos/agaa/shaders/programs.h"
#include "pipeline/shade/bit_ops-inl.h"
#include "pipeline/simd/vec-inl.h"
#if defined(HWSIM_ALGOS_AGAA_SHADERS_RECORD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_AGAA_SHADERS_RECORD_INL_H_
#undef HWSIM_ALGOS_AGAA_SHADERS_RECORD_INL_H_
#else
#define HWSIM_ALGOS_AGAA_SHADERS_RECORD_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

namespace lanes = pipeline::HWY_NAMESPACE;
using lanes::angle_turns;
using lanes::arccosine;
using lanes::bit_count;
using lanes::cosine_turns;
using lanes::lowest_bit;
using lanes::shift_right_by;
using lanes::sine_turns;
using lanes::Vec2;
using lanes::Vec3;
using lanes::Vec4;

/// Whether a shader runs to be counted: then work for counters alone is left out.
template <class S>
inline constexpr bool kCounting = std::is_same_v<typename S::F, pipeline::CountF>;

template <class F>
struct PixelBasis {
  Vec3<F> x, y, z;
};

template <class F>
Vec3<F> constant(const glm::vec3& v) {
  return {F(v.x), F(v.y), F(v.z)};
}

/// Z to the eye, X level, Y completes them.
template <class F, class I>
PixelBasis<F> pixel_basis(const PixelRays& rays, I px, I py) {
  const Vec3<F> ray = constant<F>(rays.first) + constant<F>(rays.per_x) * to_float(px) +
                      constant<F>(rays.per_y) * to_float(py);
  PixelBasis<F> basis;
  basis.z = normalize(-ray);
  const auto steep = abs(basis.z.y) > F(0.999f);
  const Vec3<F> up = {F(0.0f), select(steep, F(0.0f), F(1.0f)), select(steep, F(1.0f), F(0.0f))};
  basis.x = normalize(cross(up, basis.z));
  basis.y = cross(basis.z, basis.x);
  return basis;
}

/// theta / (pi/2) and phi as the two channels of a rg8_unorm code; the normal is turned toward the eye.
template <class F>
Vec2<F> encode_pixel_normal(const PixelBasis<F>& basis, const Vec3<F>& n) {
  const F x = dot(n, basis.x), y = dot(n, basis.y), z = dot(n, basis.z);
  const F side = select(z < F(0.0f), F(-1.0f), F(1.0f));
  const F theta = arccosine(min(max(z * side, F(0.0f)), F(1.0f))) * F(0.6366197724f);
  const F step = floor(angle_turns(y * side, x * side) * F(256.0f) + F(0.5f));
  const F wrapped = select(step > F(255.5f), F(0.0f), step);
  return {theta, wrapped * F(1.0f / 255.0f)};
}

/// In the pixel's basis.
template <class F>
Vec3<F> decode_pixel_normal(F theta_code, F phi_code) {
  const F theta = theta_code * F(0.25f);        // turns
  const F phi = phi_code * F(255.0f / 256.0f);  // turns
  const F radius = sine_turns(theta);
  return {radius * cosine_turns(phi), radius * sine_turns(phi), cosine_turns(theta)};
}

/// The means of an aggregate, or a fragment's part of them: weighted by covered samples over all samples.
template <class F, class I>
struct AggregateRecord {
  F shape[6];
  F luma, cb, cr;  ///< specular; cb and cr with their bias
  Vec3<F> albedo;
  F emissive;
  Vec3<F> normal;  ///< geometric target
  F gloss;
  F depth, depth2;
  I mask;   ///< which samples it covers, where masks are kept
  F count;  ///< samples
};

constexpr int shape_scalars(Ndf ndf) { return ndf == Ndf::toksvig ? 3 : ndf == Ndf::lean ? 5 : 6; }

/// Calls use(value, word) for every scalar that a record has, with its word in the storage buffer.
template <class Record, class Use>
void for_each_scalar(Ndf ndf, bool geometric, Record& r, Use&& use) {
  for (int i = 0; i < shape_scalars(ndf); ++i) use(r.shape[i], i);
  int word = 6;
  for (auto* v : {&r.luma, &r.cb, &r.cr, &r.albedo.x, &r.albedo.y, &r.albedo.z, &r.emissive}) use(*v, word++);
  if (!geometric) return;
  for (auto* v : {&r.normal.x, &r.normal.y, &r.normal.z, &r.gloss}) use(*v, word++);
}
inline constexpr int kMaskWord = kAggregateWords - 1;

/// No chroma: a code of 8 bits, and a whole one at any eighth, 16th or 32nd of full weight, so that gray
/// stays gray. A half would round to 0.502, a tint of 9 % in the reflectance 0.04.
inline constexpr float kNoChroma = 128.0f / 255.0f;
inline constexpr float kChromaRange = 2.0f * (1.0f - kNoChroma);

template <class F>
void encode_specular(const Vec3<F>& rgb, F& luma, F& cb, F& cr) {  // BT.601, full range
  luma = rgb.x * F(0.299f) + rgb.y * F(0.587f) + rgb.z * F(0.114f);
  cb = (rgb.z - luma) * F(kChromaRange * 0.5643340858f) + F(kNoChroma);
  cr = (rgb.x - luma) * F(kChromaRange * 0.7132667618f) + F(kNoChroma);
}
template <class F>
Vec3<F> decode_specular(F luma, F cb, F cr) {
  const F b = luma + (cb - F(kNoChroma)) * F(1.772f / kChromaRange),
          r = luma + (cr - F(kNoChroma)) * F(1.402f / kChromaRange);
  const F g = (luma - r * F(0.299f) - b * F(0.114f)) * F(1.0f / 0.587f);
  return {max(r, F(0.0f)), max(g, F(0.0f)), max(b, F(0.0f))};
}

/// What a normalized Blinn-Phong lobe of exponent s reflects in total, times a constant.
template <class F>
F lobe_energy(F s) {
  return (s + F(8.0f)) / (s + F(1.0f));
}

/// The specular color times what its lobe reflects: linear, so that it averages to the true color whatever
/// the lobes are. Chroma beyond its range loses saturation.
template <class F>
void scale_specular(const AggregateUniforms& u, F energy, F& luma, F& cb, F& cr) {
  luma = luma * energy * F(1.0f / u.most_energy);
  const F b = cb - F(kNoChroma), r = cr - F(kNoChroma);
  const F scale = min(energy * F(1.0f / u.most_chroma_energy),
                      F(0.5f * kChromaRange) / max(max(abs(b), abs(r)), F(1e-6f)));
  cb = F(kNoChroma) + b * scale;
  cr = F(kNoChroma) + r * scale;
}

/// What the vector's exponent is beyond the material's (docs/techniques/agaa.md#shading). `luma`: as
/// stored.
template <class F>
F matte_exponent(const AggregateUniforms& u, const Vec3<F>& albedo, F luma) {
  const F matte = albedo.x * F(0.299f) + albedo.y * F(0.587f) + albedo.z * F(0.114f);
  return F(u.matte_exponent) * matte / max(matte + luma, F(1e-4f));
}

/// One byte of a mask as a unorm8 channel: disjoint masks add without carry.
template <class F, class I>
F mask_byte(I mask, int byte) {
  I bits = mask;
  if (byte == 1) bits = shift_right<8>(mask);
  if (byte == 2) bits = shift_right<16>(mask);
  if (byte == 3) bits = shift_right<24>(mask);
  return to_float(bits & I(255)) * F(1.0f / 255.0f);
}
template <class I, class F>
I byte_of(F channel) {
  return to_int(channel * F(255.0f) + F(0.5f));
}

/// output(target, color) for each target of the record.
template <class F, class I, class Output>
void emit_record(const AggregateTargets& t, Ndf ndf, const AggregateRecord<F, I>& r, Output&& output) {
  const F zero(0.0f);
  const F* v = r.shape;
  switch (ndf) {
    case Ndf::toksvig:
      output(t.shape, Vec4<F>{v[0], v[1], v[2], r.luma});
      break;
    case Ndf::lean:
      output(t.shape, Vec4<F>{v[0], v[1], v[2], v[3]});
      output(t.shape_rest, Vec4<F>{v[4], r.luma, zero, zero});
      break;
    case Ndf::sggx:
      output(t.shape, Vec4<F>{v[0], v[1], v[2], v[3]});
      output(t.shape_rest, Vec4<F>{v[4], v[5], zero, zero});
      output(t.luma, Vec4<F>{r.luma, zero, zero, zero});
      break;
  }
  output(t.albedo, Vec4<F>{r.albedo.x, r.albedo.y, r.albedo.z, zero});
  const bool own_word = t.mask_word >= 0;
  const F byte = t.counts_samples ? r.count * F(1.0f / 255.0f) : mask_byte<F>(r.mask, 0);
  output(t.chroma, Vec4<F>{r.cb, r.cr, r.emissive, own_word ? zero : byte});
  if (t.geometric >= 0) output(t.geometric, Vec4<F>{r.normal.x, r.normal.y, r.normal.z, r.gloss});
  if (t.moments >= 0) output(t.moments, Vec4<F>{r.depth, r.depth2, zero, zero});
  if (t.mask_1 >= 0) output(t.mask_1, Vec4<F>{mask_byte<F>(r.mask, 1), zero, zero, zero});
  if (t.mask_2 >= 0) output(t.mask_2, Vec4<F>{mask_byte<F>(r.mask, 2), mask_byte<F>(r.mask, 3), zero, zero});
  if (own_word)
    output(t.mask_word, Vec4<F>{mask_byte<F>(r.mask, 0), mask_byte<F>(r.mask, 1), mask_byte<F>(r.mask, 2),
                                mask_byte<F>(r.mask, 3)});
}

/// The mask and the number of samples, from load(target).
template <class F, class I, class Load>
void load_mask(const AggregateTargets& t, const Vec4<F>& chroma, Load&& load, AggregateRecord<F, I>& r) {
  r.mask = I(0);
  if (t.counts_samples) {
    r.count = floor(chroma.w * F(255.0f) + F(0.5f));
    return;
  }
  if (t.mask_word >= 0) {
    const Vec4<F> m = load(t.mask_word);
    r.mask = byte_of<I>(m.x) | shift_left<8>(byte_of<I>(m.y)) | shift_left<16>(byte_of<I>(m.z)) |
             shift_left<24>(byte_of<I>(m.w));
  } else {
    r.mask = byte_of<I>(chroma.w);
    if (t.mask_1 >= 0) r.mask = r.mask | shift_left<8>(byte_of<I>(load(t.mask_1).x));
    if (t.mask_2 >= 0) {
      const Vec4<F> m = load(t.mask_2);
      r.mask = r.mask | shift_left<16>(byte_of<I>(m.x)) | shift_left<24>(byte_of<I>(m.y));
    }
  }
  r.count = to_float(bit_count(r.mask));
}

/// The rest, from load(target).
template <class F, class I, class Load>
void load_record(const AggregateTargets& t, Ndf ndf, const Vec4<F>& chroma, Load&& load,
                 AggregateRecord<F, I>& r) {
  const F zero(0.0f);
  const Vec4<F> shape = load(t.shape);
  r.shape[0] = shape.x;
  r.shape[1] = shape.y;
  r.shape[2] = shape.z;
  r.shape[3] = r.shape[4] = r.shape[5] = zero;
  r.luma = shape.w;
  if (ndf != Ndf::toksvig) {
    const Vec4<F> rest = load(t.shape_rest);
    r.shape[3] = shape.w;
    r.shape[4] = rest.x;
    r.luma = rest.y;
    if (ndf == Ndf::sggx) {
      r.shape[5] = rest.y;
      r.luma = load(t.luma).x;
    }
  }
  const Vec4<F> albedo = load(t.albedo);
  r.albedo = {albedo.x, albedo.y, albedo.z};
  r.cb = chroma.x;
  r.cr = chroma.y;
  r.emissive = chroma.z;
  r.normal = {zero, zero, zero};
  r.gloss = r.depth = r.depth2 = zero;
  if (t.geometric >= 0) {
    const Vec4<F> g = load(t.geometric);
    r.normal = {g.x, g.y, g.z};
    r.gloss = g.w;
  }
  if (t.moments >= 0) {
    const Vec4<F> m = load(t.moments);
    r.depth = m.x;
    r.depth2 = m.y;
  }
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
