// Formats against exact rational arithmetic (every value of these formats, and every product below, is exact
// in double or in 128-bit integers), and the transcendental functions against the library's doubles.
#include "pipeline/simd/codec-inl.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "pipeline/image/image.h"
#include "pipeline/simd/scalar_lane-inl.h"

namespace hwsim::pipeline {
namespace {
using namespace HWY_NAMESPACE;  // the scalar lane of the static target

struct Words {
  std::uint32_t w[4];
};

Words encode(Format format, float r, float g = 0, float b = 0, float a = 0) {
  ScalarI words[4] = {0, 0, 0, 0};
  encode_texel<ScalarF, ScalarI>(format, {r, g, b, a}, words);
  Words out;
  for (int i = 0; i < 4; ++i) out.w[i] = static_cast<std::uint32_t>(words[i].v);
  return out;
}

std::array<float, 4> decode(Format format, const Words& words) {
  ScalarI w[4];
  for (int i = 0; i < 4; ++i) w[i] = static_cast<std::int32_t>(words.w[i]);
  const auto c = decode_texel<ScalarF, ScalarI>(format, w, srgb_decode_table().data());
  return {c.x.v, c.y.v, c.z.v, c.w.v};
}

/// One channel of a format: its word and bits.
struct Channel {
  Format format;
  int component, word, shift, bits;
};

enum class Kind { unorm, snorm, small_float };
struct ChannelCase {
  Channel channel;
  Kind kind;
  int mantissa = 0;
};

std::vector<ChannelCase> channel_cases() {
  std::vector<ChannelCase> all;
  const auto add = [&](Format f, Kind kind, std::initializer_list<int> bits, int mantissa = 0) {
    int component = 0, at = 0;
    for (const int b : bits) {
      const int m = kind == Kind::small_float && b == 10 ? 5 : mantissa;
      all.push_back({{f, component++, at / 32, at % 32, b}, kind, m});
      at += b;
    }
  };
  add(Format::r8_unorm, Kind::unorm, {8});
  add(Format::rg8_unorm, Kind::unorm, {8, 8});
  add(Format::rgba8_unorm, Kind::unorm, {8, 8, 8, 8});
  add(Format::rgba8_snorm, Kind::snorm, {8, 8, 8, 8});
  add(Format::rgb10a2_unorm, Kind::unorm, {10, 10, 10, 2});
  add(Format::r11g11b10_float, Kind::small_float, {11, 11, 10}, 6);
  add(Format::r16_float, Kind::small_float, {16}, 10);
  add(Format::rg16_float, Kind::small_float, {16, 16}, 10);
  add(Format::rg16_snorm, Kind::snorm, {16, 16});
  add(Format::rgba16_float, Kind::small_float, {16, 16, 16, 16}, 10);
  add(Format::rgba16_unorm, Kind::unorm, {16, 16, 16, 16});
  add(Format::rgba16_snorm, Kind::snorm, {16, 16, 16, 16});
  return all;
}

std::uint32_t encode_channel(const Channel& c, float value) {
  float rgba[4] = {0, 0, 0, 0};
  rgba[c.component] = value;
  const Words words = encode(c.format, rgba[0], rgba[1], rgba[2], rgba[3]);
  const std::uint32_t mask = (1u << c.bits) - 1;
  for (int i = 0; i < 4; ++i) {  // nothing spills into other channels: they encode 0
    const std::uint32_t rest = words.w[i] & ~(i == c.word ? mask << c.shift : 0u);
    EXPECT_EQ(rest, 0u) << info(c.format).name << " component " << c.component;
  }
  return words.w[c.word] >> c.shift & mask;
}

float decode_channel(const Channel& c, std::uint32_t code) {
  Words words{};
  words.w[c.word] = code << c.shift;
  return decode(c.format, words)[static_cast<std::size_t>(c.component)];
}

bool has_sign(const ChannelCase& c) {
  return c.kind == Kind::snorm || (c.kind == Kind::small_float && c.channel.bits == 16);
}

// The value of a code; NaN where the code is none that the product writes.
double exact_value(const ChannelCase& c, std::uint32_t code) {
  const double max_unorm = std::ldexp(1.0, c.channel.bits) - 1,
               max_snorm = std::ldexp(1.0, c.channel.bits - 1) - 1;
  if (c.kind == Kind::unorm) return code / max_unorm;
  if (c.kind == Kind::snorm) {
    const double v =
        code >= std::ldexp(1.0, c.channel.bits - 1) ? code - std::ldexp(1.0, c.channel.bits) : code;
    return v < -max_snorm ? NAN : v / max_snorm;
  }
  const std::uint32_t mantissa = code & ((1u << c.mantissa) - 1), exponent = code >> c.mantissa & 31;
  const double sign = c.channel.bits == 16 && code >> 15 != 0 ? -1 : 1;
  if (exponent == 31) return NAN;
  if (exponent == 0) return sign * std::ldexp(mantissa, -14 - c.mantissa);
  return sign * std::ldexp(mantissa + (1u << c.mantissa), static_cast<int>(exponent) - 15 - c.mantissa);
}

TEST(Codec, ReadsBackEveryCodeOfEveryChannel) {
  for (const ChannelCase& c : channel_cases()) {
    SCOPED_TRACE(std::string(info(c.channel.format).name) + " component " +
                 std::to_string(c.channel.component));
    for (std::uint32_t code = 0; code < 1u << c.channel.bits; ++code) {
      const double exact = exact_value(c, code);
      if (std::isnan(exact)) continue;
      const float value = decode_channel(c.channel, code);
      // Normalized values are a product by the float nearest to 1/max: two roundings.
      ASSERT_NEAR(value, exact, c.kind == Kind::small_float ? 0.0 : 1.2e-7 * std::fabs(exact)) << code;
      ASSERT_EQ(encode_channel(c.channel, value), code);
    }
  }
}

// Distance of a value from a code's, in units of the code's last place; for floats between neighbors' values.
TEST(Codec, RoundsToTheNearestCode) {
  std::mt19937 random(1);
  std::uint64_t checked = 0;
  for (const ChannelCase& c : channel_cases()) {
    SCOPED_TRACE(std::string(info(c.channel.format).name) + " component " +
                 std::to_string(c.channel.component));
    for (int i = 0; i < 20000; ++i) {
      float x = static_cast<float>(random() >> 8) * 0x1p-24f;
      if (c.kind == Kind::small_float) x = std::ldexp(x + 0.5f, static_cast<int>(random() % 34) - 18);
      if (has_sign(c) && (random() & 1) != 0) x = -x;
      const std::uint32_t code = encode_channel(c.channel, x);
      const double at = exact_value(c, code);
      ASSERT_FALSE(std::isnan(at)) << x;
      if (c.kind != Kind::small_float) {
        // The product by max is rounded before it is rounded to an integer: at 16 bits by 2^-9.
        const double last = 1.0 / (std::ldexp(1.0, c.channel.bits - (c.kind == Kind::snorm ? 1 : 0)) - 1);
        ASSERT_LE(std::fabs(static_cast<double>(x) - at), last * (0.5 + 0x1p-8)) << x;
        ++checked;
        continue;
      }
      const double largest = exact_value(c, c.channel.bits == 16 ? 0x7bff : (31u << c.mantissa) - 1);
      if (std::fabs(static_cast<double>(x)) >= largest) {
        ASSERT_EQ(std::fabs(at), largest);
        continue;
      }
      const std::uint32_t magnitude = code & (c.channel.bits == 16 ? 0x7fffu : 0xffffu);
      const double here = std::fabs(at), value = std::fabs(static_cast<double>(x));
      for (const std::uint32_t neighbor : {magnitude + 1, magnitude - (magnitude > 0 ? 1 : 0)}) {
        const double other = exact_value(c, neighbor);
        if (std::isnan(other) || neighbor == magnitude) continue;
        ASSERT_LE(std::fabs(value - here), std::fabs(value - other)) << x;
        if (std::fabs(value - here) == std::fabs(value - other)) {
          ASSERT_EQ(magnitude & 1, 0u) << x;
        }
      }
      ++checked;
    }
  }
  EXPECT_GT(checked, 400000u);
}

TEST(Codec, RoundsTiesToEven) {
  for (const ChannelCase& c : channel_cases()) {
    if (c.kind != Kind::small_float) continue;
    SCOPED_TRACE(std::string(info(c.channel.format).name));
    for (std::uint32_t code = 0; code < 30u << c.mantissa; ++code) {
      const double middle =
          0.5 * (exact_value(c, code) + exact_value(c, code + 1));  // exact in a float as well
      ASSERT_EQ(encode_channel(c.channel, static_cast<float>(middle)), code + (code & 1)) << code;
    }
  }
  EXPECT_EQ(encode(Format::rgb10a2_unorm, 0, 0, 0, 0.5f).w[0] >> 30, 2u);  // 1.5 of 3
}

TEST(Codec, NeverWritesInfinityNorNotANumber) {
  const float odd[] = {INFINITY, -INFINITY, NAN, -NAN, 3.4e38f, -3.4e38f, 65520.0f, 1e-45f, -1e-45f};
  for (int f = static_cast<int>(Format::r8_unorm); f <= static_cast<int>(Format::rgba32_uint); ++f) {
    const auto format = static_cast<Format>(f);
    if (info(format).is_integer) continue;
    for (const float x : odd)
      for (const float back : decode(format, encode(format, x, x, x, x)))
        EXPECT_TRUE(std::isfinite(back)) << info(format).name << " " << x;
  }
}

TEST(Codec, EncodesSrgbWithinSixTenthsOfACode) {
  for (std::uint32_t code = 0; code < 256; ++code) {
    const float linear = srgb_decode_table()[code];
    EXPECT_EQ(encode(Format::rgba8_srgb, linear, linear, linear, 0).w[0], code * 0x010101u);
  }
  double worst = 0.0;
  for (int i = 0; i <= 1 << 20; ++i) {
    const double x = std::ldexp(i, -20);
    const double exact = 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
    const double code = encode(Format::rgba8_srgb, static_cast<float>(x)).w[0] & 255u;
    worst = std::max(worst, std::fabs(code - exact));
  }
  EXPECT_LE(worst, 0.502);  // Direct3D asks for 0.6
  std::printf("[     note ] sRGB encoding: at most %.4f codes off\n", worst);
}

TEST(Codec, KeepsThirtyTwoBitsAsTheyAre) {
  for (const float x : {0.0f, -0.0f, 1.5f, -3e-30f, 3.4028235e38f}) {
    const Words words = encode(Format::rgba32_float, x, -x, 2 * x > 3e38f ? x : 2 * x, 1.0f);
    EXPECT_EQ(words.w[0], std::bit_cast<std::uint32_t>(x));
    EXPECT_EQ(words.w[1], std::bit_cast<std::uint32_t>(-x));
    EXPECT_EQ(decode(Format::rgba32_float, words)[0], x);
  }
  for (const float id : {0.0f, 1.0f, 16777215.0f}) {
    EXPECT_EQ(encode(Format::r32_uint, id).w[0], static_cast<std::uint32_t>(id));
    EXPECT_EQ(decode(Format::rgba32_uint, encode(Format::rgba32_uint, 1, id, 3, 4))[1], id);
  }
}

TEST(Transcendental, Exp2StaysWithinItsError) {
  double worst = 0.0;
  for (int i = -126 * 65536; i <= 127 * 65536; i += 1) {
    const float x = static_cast<float>(i) / 65536.0f;
    const double exact = std::exp2(static_cast<double>(x));
    worst = std::max(worst, std::fabs(exp2(ScalarF(x)).v / exact - 1.0));
  }
  EXPECT_LT(worst, 2.4e-7);
  EXPECT_EQ(exp2(ScalarF(-200.0f)).v, 0x1p-126f);
  EXPECT_EQ(exp2(ScalarF(200.0f)).v, 0x1p127f);
  for (int i = -126; i <= 127; ++i) EXPECT_EQ(exp2(ScalarF(static_cast<float>(i))).v, std::ldexp(1.0f, i));
  std::printf("[     note ] exp2: relative error %.3g\n", worst);
}

TEST(Transcendental, Log2StaysWithinItsError) {
  double near_one = 0.0, elsewhere = 0.0;
  for (std::uint32_t bits = 0x00800000u; bits < 0x7f800000u; bits += 97) {
    const float x = std::bit_cast<float>(bits);
    const double exact = std::log2(static_cast<double>(x)), error = std::fabs(log2(ScalarF(x)).v - exact);
    if (x >= 0.5f && x <= 2.0f)
      near_one = std::max(near_one, error);
    else
      elsewhere = std::max(elsewhere, error / std::fabs(exact));
  }
  EXPECT_LT(near_one, 4e-7);
  EXPECT_LT(elsewhere, 2e-7);
  EXPECT_EQ(log2(ScalarF(0.0f)).v, -126.0f);
  std::printf("[     note ] log2: absolute error %.3g in [1/2, 2], relative %.3g elsewhere\n", near_one,
              elsewhere);
}

}  // namespace
}  // namespace hwsim::pipeline
