// The record that SBAA keeps of a surface (docs/techniques/sbaa.md#records), packed with the codecs of the
// G-buffer's formats, so that a record and a sample of gb_sbaa40 hold the same values. Per-target include
// guard.
#include <hwy/highway.h>
#include "algos/base/shaders/gbuffer-inl.h"
#include "algos/sbaa/shaders/programs.h"
#include "pipeline/image/image.h"
#if defined(HWSIM_ALGOS_SBAA_SHADERS_RECORD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_ALGOS_SBAA_SHADERS_RECORD_INL_H_
#undef HWSIM_ALGOS_SBAA_SHADERS_RECORD_INL_H_
#else
#define HWSIM_ALGOS_SBAA_SHADERS_RECORD_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::algos::HWY_NAMESPACE {

template <class F, class I>
I pack(Format format, F x, F y, F z, F w) {
  I words[4] = {I(0), I(0), I(0), I(0)};
  lanes::encode_texel<F, I>(format, lanes::Vec4<F>{x, y, z, w}, words);
  return words[0];
}

template <class F, class I>
lanes::Vec4<F> unpack(Format format, I word) {
  const I words[4] = {word, I(0), I(0), I(0)};
  return lanes::decode_texel<F, I>(format, words, pipeline::srgb_decode_table().data());
}

/// The first word is never 0: it says that the slot was written. `z`: depth at the pixel's center, for
/// compact records.
template <bool kFull, class F, class I>
void encode_record(const GBufferValues<F>& v, F z, I (&words)[8]) {
  const auto n = encode_normal(v.normal);
  const F zero(0.0f);
  const I base = pack<F, I>(Format::rgba8_srgb, v.base.x, v.base.y, v.base.z, v.metallic);
  const I emissive = pack<F, I>(Format::r11g11b10_float, v.emissive.x, v.emissive.y, v.emissive.z, zero);
  if constexpr (kFull) {
    words[0] = float_to_bits(max(v.roughness, F(v.least_roughness)));
    words[1] = float_to_bits(v.position.x);
    words[2] = float_to_bits(v.position.y);
    words[3] = float_to_bits(v.position.z);
    words[4] = pack<F, I>(Format::rg16_snorm, n.x, n.y, zero, zero);
    words[5] = base;
    words[6] = emissive;
    words[7] = pack<F, I>(Format::rg16_float, v.gradient.x, v.gradient.y, zero, zero);
  } else {
    const auto twelve_bits = [](F x) HWY_ATTR { return to_int(lanes::round_even(x * F(2047.0f))) + I(2048); };
    words[0] = float_to_bits(max(z, F(1e-30f)));
    words[1] = twelve_bits(n.x) | shift_left<12>(twelve_bits(n.y)) |
               shift_left<24>(lanes::pack_unorm<F, I>(v.roughness, 255.0f));
    words[2] = base;
    words[3] = emissive;
  }
}

/// A record's surface at pixel (x, y).
template <bool kFull, class S, class F, class I>
lanes::Surface<F> decode_record(const DeferredUniforms& u, I x, I y, const I (&words)[8]) {
  lanes::Surface<F> surface;
  F roughness;
  if constexpr (kFull) {
    roughness = bits_to_float(words[0]);
    surface.position = {bits_to_float(words[1]), bits_to_float(words[2]), bits_to_float(words[3])};
    const auto n = unpack<F, I>(Format::rg16_snorm, words[4]);
    surface.normal = decode_normal(n.x, n.y);
  } else {
    surface.position = unproject<S>(u.world_from_clip, u, x, y, F(0.0f), F(0.0f), bits_to_float(words[0]));
    const auto from_twelve = [](I code) HWY_ATTR {
      return to_float((code & I(4095)) - I(2048)) * F(1.0f / 2047.0f);
    };
    surface.normal = decode_normal(from_twelve(words[1]), from_twelve(shift_right<12>(words[1])));
    roughness = to_float(shift_right<24>(words[1]) & I(255)) * F(1.0f / 255.0f);
  }
  const auto base = unpack<F, I>(Format::rgba8_srgb, words[kFull ? 5 : 2]);
  const auto emissive = unpack<F, I>(Format::r11g11b10_float, words[kFull ? 6 : 3]);
  lanes::set_material(lanes::Vec3<F>{base.x, base.y, base.z}, base.w, roughness, surface);
  surface.emissive = {emissive.x, emissive.y, emissive.z};
  show_marked(u.lighting, roughness, surface);
  surface.to_eye = normalize(lanes::broadcast<F>(u.lighting.eye) - surface.position);
  return surface;
}

/// Word index of a slot's record.
template <class I>
I record_index(const SbaaSurfaces& u, I x, I y, I slot) {
  return ((y * I(u.width) + x) * I(u.slots) + slot) * I(u.record_words);
}

/// Truncated number and sample count of a slot.
template <class S>
void load_surface(S& s, const SbaaSurfaces& u, int image_slot, int slot, typename S::I (&surface)[2]) {
  using I = typename S::I;
  s.load_image_int(image_slot, s.pixel_x(), s.pixel_y() + I(slot * u.height), I(0), surface);
}

}  // namespace hwsim::algos::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
