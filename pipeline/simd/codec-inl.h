// Formats encoded and decoded on any lane type, with the rounding of Direct3D 11: to nearest even for
// normalized and float formats. Values beyond a float format's range are clamped to its largest finite value,
// NaN becomes 0, so that neither reaches an image. Per-target include guard, see simd/lanes-inl.h.
#include <hwy/highway.h>
#include "hwsim/trace/format.h"
#include "pipeline/simd/vec-inl.h"
#if defined(HWSIM_SIMD_CODEC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HWSIM_SIMD_CODEC_INL_H_
#undef HWSIM_SIMD_CODEC_INL_H_
#else
#define HWSIM_SIMD_CODEC_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

template <class F>
F saturate(F x) {
  return min(max(x, F(0.0f)), F(1.0f));
}

/// To the nearest integer, ties to even, for |x| < 2^22: adding 1.5 * 2^23 leaves no fraction bits.
template <class F>
F round_even(F x) {
  return (x + F(12582912.0f)) - F(12582912.0f);
}

template <class F, class I>
I pack_unorm(F x, float max_code) {
  return to_int(round_even(saturate(x) * F(max_code)));
}

template <class F, class I>
I pack_snorm(F x, float max_code, int mask) {
  const F clamped = min(max(x, F(-1.0f)), F(1.0f));
  return to_int(round_even(clamped * F(max_code))) & I(mask);
}

/// Unsigned float of 5 exponent bits and kMantissa mantissa bits (6: R11 and G11, 5: B10, 10: half without
/// sign).
template <int kMantissa, class F, class I>
I pack_small_float(F x, float largest) {
  const F clamped = min(max(x, F(0.0f)), F(largest));
  // Denormals: adding 2^(23 - 14 - kMantissa) aligns the mantissa so that the addition itself rounds to
  // nearest even.
  const F magic = bits_to_float(I((127 + 23 - 14 - kMantissa) << 23));
  const I denormal = float_to_bits(clamped + magic) - float_to_bits(magic);
  const I bits = float_to_bits(clamped);
  constexpr int kShift = 23 - kMantissa;
  const I odd = shift_right<kShift>(bits) & I(1);
  const I rounded = bits + I((1 << (kShift - 1)) - 1) + odd - I((127 - 15) << 23);
  return select(clamped < F(6.103515625e-5f), denormal, shift_right<kShift>(rounded));
}

template <int kMantissa, class F, class I>
F unpack_small_float(I code) {
  return bits_to_float(shift_left<23 - kMantissa>(code)) * bits_to_float(I((127 + 127 - 15) << 23));
}

template <class F, class I>
I pack_half(F x) {
  const I sign = shift_right<16>(float_to_bits(x)) & I(0x8000);
  return pack_small_float<10, F, I>(abs(x), 65504.0f) | sign;
}

template <class F, class I>
F unpack_half(I code) {
  const F magnitude = unpack_small_float<10, F, I>(code & I(0x7fff));
  return bits_to_float(float_to_bits(magnitude) | shift_left<16>(code & I(0x8000)));
}

template <class F, class I>
F srgb_encode(F linear) {
  const F x = saturate(linear);
  const F curve = F(1.055f) * exp2(log2(x) * F(1.0f / 2.4f)) - F(0.055f);
  return select(x <= F(0.0031308f), F(12.92f) * x, curve);
}

/// Words of one texel, as stored in GpuImage. Integer formats take the value's integer part.
template <class F, class I>
void encode_texel(Format format, const Vec4<F>& c, I (&words)[4]) {
  const auto u8 = [](F x) HWY_ATTR { return pack_unorm<F, I>(x, 255.0f); };
  const auto u16 = [](F x) HWY_ATTR { return pack_unorm<F, I>(x, 65535.0f); };
  const auto s16 = [](F x) HWY_ATTR { return pack_snorm<F, I>(x, 32767.0f, 0xffff); };
  const auto s8 = [](F x) HWY_ATTR { return pack_snorm<F, I>(x, 127.0f, 0xff); };
  const auto half = [](F x) HWY_ATTR { return pack_half<F, I>(x); };
  const auto finite = [](F x) HWY_ATTR {
    return float_to_bits(min(max(x, F(-3.4028235e38f)), F(3.4028235e38f)));
  };
  switch (format) {
    case Format::r8_unorm:
      words[0] = u8(c.x);
      break;
    case Format::rg8_unorm:
      words[0] = u8(c.x) | shift_left<8>(u8(c.y));
      break;
    case Format::rgba8_unorm:
      words[0] = u8(c.x) | shift_left<8>(u8(c.y)) | shift_left<16>(u8(c.z)) | shift_left<24>(u8(c.w));
      break;
    case Format::rgba8_srgb:
      words[0] = u8(srgb_encode<F, I>(c.x)) | shift_left<8>(u8(srgb_encode<F, I>(c.y))) |
                 shift_left<16>(u8(srgb_encode<F, I>(c.z))) | shift_left<24>(u8(c.w));
      break;
    case Format::rgba8_snorm:
      words[0] = s8(c.x) | shift_left<8>(s8(c.y)) | shift_left<16>(s8(c.z)) | shift_left<24>(s8(c.w));
      break;
    case Format::rgb10a2_unorm:
      words[0] = pack_unorm<F, I>(c.x, 1023.0f) | shift_left<10>(pack_unorm<F, I>(c.y, 1023.0f)) |
                 shift_left<20>(pack_unorm<F, I>(c.z, 1023.0f)) | shift_left<30>(pack_unorm<F, I>(c.w, 3.0f));
      break;
    case Format::r11g11b10_float:
      words[0] = pack_small_float<6, F, I>(c.x, 65024.0f) |
                 shift_left<11>(pack_small_float<6, F, I>(c.y, 65024.0f)) |
                 shift_left<22>(pack_small_float<5, F, I>(c.z, 64512.0f));
      break;
    case Format::r16_float:
      words[0] = half(c.x);
      break;
    case Format::rg16_float:
      words[0] = half(c.x) | shift_left<16>(half(c.y));
      break;
    case Format::rg16_snorm:
      words[0] = s16(c.x) | shift_left<16>(s16(c.y));
      break;
    case Format::rgba16_float:
      words[0] = half(c.x) | shift_left<16>(half(c.y));
      words[1] = half(c.z) | shift_left<16>(half(c.w));
      break;
    case Format::rgba16_unorm:
      words[0] = u16(c.x) | shift_left<16>(u16(c.y));
      words[1] = u16(c.z) | shift_left<16>(u16(c.w));
      break;
    case Format::rgba16_snorm:
      words[0] = s16(c.x) | shift_left<16>(s16(c.y));
      words[1] = s16(c.z) | shift_left<16>(s16(c.w));
      break;
    case Format::r32_float:
      words[0] = finite(c.x);
      break;
    case Format::rg32_float:
      words[0] = finite(c.x);
      words[1] = finite(c.y);
      break;
    case Format::rgba32_float:
      words[0] = finite(c.x);
      words[1] = finite(c.y);
      words[2] = finite(c.z);
      words[3] = finite(c.w);
      break;
    default:  // integer formats below 16777216 a channel; depth formats are not color targets
      words[0] = to_int(c.x);
      words[1] = to_int(c.y);
      words[2] = to_int(c.z);
      words[3] = to_int(c.w);
      break;
  }
}

template <class F, class I>
F unpack_snorm(I code, float max_code, int sign_bit) {
  const I value = code - select(code > I(sign_bit - 1), I(2 * sign_bit), I(0));
  return max(to_float(value) * F(1.0f / max_code), F(-1.0f));
}

/// The inverse; channels that a format lacks read 0, alpha 1. `srgb_table`: srgb_decode_table().
template <class F, class I>
Vec4<F> decode_texel(Format format, const I (&w)[4], const float* srgb_table) {
  const auto u8 = [&](I x) HWY_ATTR { return to_float(x & I(255)) * F(1.0f / 255.0f); };
  const auto u16 = [&](I x) HWY_ATTR { return to_float(x & I(65535)) * F(1.0f / 65535.0f); };
  const auto s16 = [&](I x) HWY_ATTR { return unpack_snorm<F, I>(x & I(65535), 32767.0f, 32768); };
  const auto s8 = [&](I x) HWY_ATTR { return unpack_snorm<F, I>(x & I(255), 127.0f, 128); };
  const auto half = [&](I x) HWY_ATTR { return unpack_half<F, I>(x & I(65535)); };
  const F zero(0.0f), one(1.0f);
  switch (format) {
    case Format::r8_unorm:
      return {u8(w[0]), zero, zero, one};
    case Format::rg8_unorm:
      return {u8(w[0]), u8(shift_right<8>(w[0])), zero, one};
    case Format::rgba8_unorm:
      return {u8(w[0]), u8(shift_right<8>(w[0])), u8(shift_right<16>(w[0])), u8(shift_right<24>(w[0]))};
    case Format::rgba8_srgb:
      return {lookup(srgb_table, w[0] & I(255)), lookup(srgb_table, shift_right<8>(w[0]) & I(255)),
              lookup(srgb_table, shift_right<16>(w[0]) & I(255)), u8(shift_right<24>(w[0]))};
    case Format::rgba8_snorm:
      return {s8(w[0]), s8(shift_right<8>(w[0])), s8(shift_right<16>(w[0])), s8(shift_right<24>(w[0]))};
    case Format::rgb10a2_unorm: {
      const F scale(1.0f / 1023.0f);
      return {to_float(w[0] & I(1023)) * scale, to_float(shift_right<10>(w[0]) & I(1023)) * scale,
              to_float(shift_right<20>(w[0]) & I(1023)) * scale,
              to_float(shift_right<30>(w[0]) & I(3)) * F(1.0f / 3.0f)};
    }
    case Format::r11g11b10_float:
      return {unpack_small_float<6, F, I>(w[0] & I(2047)),
              unpack_small_float<6, F, I>(shift_right<11>(w[0]) & I(2047)),
              unpack_small_float<5, F, I>(shift_right<22>(w[0]) & I(1023)), one};
    case Format::r16_float:
      return {half(w[0]), zero, zero, one};
    case Format::rg16_float:
      return {half(w[0]), half(shift_right<16>(w[0])), zero, one};
    case Format::rg16_snorm:
      return {s16(w[0]), s16(shift_right<16>(w[0])), zero, one};
    case Format::rgba16_float:
      return {half(w[0]), half(shift_right<16>(w[0])), half(w[1]), half(shift_right<16>(w[1]))};
    case Format::rgba16_unorm:
      return {u16(w[0]), u16(shift_right<16>(w[0])), u16(w[1]), u16(shift_right<16>(w[1]))};
    case Format::rgba16_snorm:
      return {s16(w[0]), s16(shift_right<16>(w[0])), s16(w[1]), s16(shift_right<16>(w[1]))};
    case Format::r32_float:
      return {bits_to_float(w[0]), zero, zero, one};
    case Format::rg32_float:
      return {bits_to_float(w[0]), bits_to_float(w[1]), zero, one};
    case Format::rgba32_float:
      return {bits_to_float(w[0]), bits_to_float(w[1]), bits_to_float(w[2]), bits_to_float(w[3])};
    case Format::d16_unorm:
      return {to_float(w[0]) * F(1.0f / 65535.0f), zero, zero, one};
    case Format::d24_unorm_s8:
      return {to_float(w[0]) * F(1.0f / 16777215.0f), zero, zero, one};
    case Format::d32_float:
    case Format::d32_float_s8:
      return {bits_to_float(w[0]), zero, zero, one};
    default:
      return {to_float(w[0]), to_float(w[1]), to_float(w[2]), to_float(w[3])};
  }
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
