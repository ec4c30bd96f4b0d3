// What is written is what another program reads: the image module, which is OpenImageIO.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "pipeline/base/file_io.h"
#include "pipeline/image/deflate.h"
#include "pipeline/image/exr_file.h"
#include "pipeline/image/image_io.h"
#include "pipeline/image/known_srgb.h"
#include "pipeline/image/make_png.h"
#include "pipeline/image/module_loader.h"
#include "pipeline/image/png_file.h"

namespace hwsim::pipeline {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <class Texel>
struct Read {
  int width = 0, height = 0;
  std::vector<Texel> values;  ///< four a pixel
  std::string error;
};

template <class Texel>
Read<Texel> read_by_module(const Bytes& file) {
  Read<Texel> read;
  std::array<char, 256> error{};
  const auto allocate = [](void* user, int width, int height) -> void* {
    auto& to = *static_cast<Read<Texel>*>(user);
    to.width = width;
    to.height = height;
    to.values.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return to.values.data();
  };
  const HwsimImageOutput output{&read, allocate, error.data(), error.size()};
  const int status =
      image_module().decode(file.data(), file.size(), std::is_same_v<Texel, float> ? 1 : 0, &output);
  if (status != kHwsimImageOk) read.error = "damaged: " + std::string(error.data());
  return read;
}

Bytes random_bytes(std::size_t count, unsigned seed, int most = 255) {
  std::mt19937 random(seed);
  Bytes bytes(count);
  for (std::uint8_t& byte : bytes)
    byte = static_cast<std::uint8_t>(random() % static_cast<unsigned>(most + 1));
  return bytes;
}

TEST(EncodePng, EveryFilterIsReadBackByAnotherProgram) {
  for (const auto& [width, height] : {std::pair(1, 1), {1, 7}, {2, 3}, {61, 40}}) {
    for (const int kind : {0, 1, 2, 3}) {
      Bytes rgb = random_bytes(static_cast<std::size_t>(3 * width * height), 5, kind == 0 ? 255 : 3);
      for (std::size_t i = 0; i < rgb.size(); ++i) {
        const auto x = static_cast<int>(i / 3) % width, y = static_cast<int>(i / 3) / width;
        if (kind > 0) rgb[i] = static_cast<std::uint8_t>(rgb[i] + (kind & 1) * 5 * x + (kind & 2) * 4 * y);
      }
      const auto read = read_by_module<std::uint8_t>(encode_png(width, height, rgb));
      ASSERT_EQ(read.error, "");
      ASSERT_EQ(read.width, width);
      ASSERT_EQ(read.height, height);
      for (std::size_t i = 0; i < rgb.size(); ++i) EXPECT_EQ(read.values[i / 3 * 4 + i % 3], rgb[i]) << i;
    }
  }
}

// Rows of filters 0 to 4 in turn, with random bytes: any is a picture.
TEST(DecodePlainPng, ReadsWhatTheModuleReads) {
  for (const int color_type : {0, 2, 4, 6}) {
    const std::size_t channels = color_type == 0 ? 1 : color_type == 2 ? 3 : color_type == 4 ? 2 : 4;
    constexpr std::size_t kWidth = 19, kHeight = 15;
    Bytes rows = random_bytes(kHeight * (1 + channels * kWidth), static_cast<unsigned>(color_type)), stream;
    for (std::size_t y = 0; y < kHeight; ++y)
      rows[y * (1 + channels * kWidth)] = static_cast<std::uint8_t>(y % 5);
    deflate(rows, stream);
    for (const bool with_remarks : {false, true}) {
      Bytes file;
      append_png_signature(file);
      append_png_chunk(
          file, "IHDR",
          Bytes{0, 0, 0, kWidth, 0, 0, 0, kHeight, 8, static_cast<std::uint8_t>(color_type), 0, 0, 0});
      if (with_remarks) append_png_chunk(file, "gAMA", Bytes{0, 1, 0x24, 0xF8});
      if (with_remarks) append_png_chunk(file, "tEXt", Bytes{'a', 0, 'b'});
      for (std::size_t at = 0; at < stream.size(); at += 100)
        append_png_chunk(file, "IDAT",
                         std::span(stream).subspan(at, std::min<std::size_t>(100, stream.size() - at)));
      append_png_chunk(file, "IEND", {});
      const auto image = decode_plain_png(file);
      const auto read = read_by_module<std::uint8_t>(file);
      ASSERT_TRUE(image);
      ASSERT_EQ(read.error, "");
      ASSERT_EQ(image->texels.size(), kWidth * kHeight);
      for (std::size_t i = 0; i < read.values.size(); ++i)
        ASSERT_EQ(image->texels[i / 4] >> (8 * (i % 4)) & 255u, read.values[i]) << color_type << ' ' << i;
    }
  }
}

TEST(DecodePlainPng, LeavesAllOthersToTheModule) {
  using testing::make_png;
  EXPECT_TRUE(decode_plain_png(make_png({1, 1, 8, 0}, {77})));
  EXPECT_FALSE(decode_plain_png(make_png({8, 1, 1, 0}, {0x80})));
  EXPECT_FALSE(decode_plain_png(make_png({1, 1, 16, 0}, {1, 2})));
  EXPECT_FALSE(decode_plain_png(make_png({2, 2, 8, 0}, {77, 77}))) << "too little data";
  EXPECT_FALSE(decode_plain_png(make_png({1, 1, 8, 0}, Bytes(9, 7)))) << "too much";
  EXPECT_FALSE(decode_plain_png(testing::two_color_jpeg()));
  Bytes keyed;
  append_png_signature(keyed);
  append_png_chunk(keyed, "IHDR", Bytes{0, 0, 0, 1, 0, 0, 0, 1, 8, 0, 0, 0, 0});
  append_png_chunk(keyed, "tRNS", Bytes{0, 77});
  Bytes stream;
  deflate(Bytes{0, 77}, stream);
  append_png_chunk(keyed, "IDAT", stream);
  append_png_chunk(keyed, "IEND", {});
  EXPECT_FALSE(decode_plain_png(keyed)) << "gray 77 is transparent";
}

/// By hand: the half's own value in double.
double value_of(std::uint16_t half) {
  const int exponent = half >> 10 & 31, digits = half & 1023;
  const double magnitude = exponent == 0 ? std::ldexp(digits, -24) : std::ldexp(1024 + digits, exponent - 25);
  return half & 0x8000 ? -magnitude : magnitude;
}

TEST(HalfFromFloat, IsTheNearestAndEvenBetweenTwo) {
  for (std::uint32_t h = 0; h < 0x7BFF; ++h) {
    const auto half = static_cast<std::uint16_t>(h), next = static_cast<std::uint16_t>(h + 1);
    const auto low = static_cast<float>(value_of(half)), high = static_cast<float>(value_of(next));
    const float middle = static_cast<float>((value_of(half) + value_of(next)) / 2);
    ASSERT_EQ(half_from_float(low), half);
    ASSERT_EQ(half_from_float(-low), half | 0x8000);
    ASSERT_EQ(half_from_float(middle), h % 2 == 0 ? half : next) << h;
    ASSERT_EQ(half_from_float(std::nextafter(middle, low)), half) << h;
    ASSERT_EQ(half_from_float(std::nextafter(middle, high)), next) << h;
  }
  EXPECT_EQ(half_from_float(65519.996f), 0x7BFF);
  EXPECT_EQ(half_from_float(65520.0f), 0x7C00);
  EXPECT_EQ(half_from_float(std::bit_cast<float>(0x7F800001u)) & 0x7C00, 0x7C00);
  EXPECT_NE(half_from_float(std::bit_cast<float>(0x7F800001u)) & 0x03FF, 0) << "still not a number";
}

TEST(EncodeExr, AnotherProgramReadsTheSameHalves) {
  for (const auto& [width, height] : {std::pair(1, 1), {3, 16}, {5, 17}, {130, 50}}) {
    std::vector<std::uint16_t> rgb(static_cast<std::size_t>(3 * width * height));
    const Bytes noise = random_bytes(2 * rgb.size(), 9);
    for (std::size_t i = 0; i < rgb.size(); ++i)  // half of the rows are smooth, half do not compress
      rgb[i] = i / 3 / static_cast<std::size_t>(width) % 32 < 16
                   ? static_cast<std::uint16_t>(0x3000 + i)
                   : static_cast<std::uint16_t>((noise[2 * i] | noise[2 * i + 1] << 8) & 0xBBFF);
    const auto read = read_by_module<float>(encode_exr_halves(width, height, rgb));
    ASSERT_EQ(read.error, "");
    ASSERT_EQ(read.width, width);
    ASSERT_EQ(read.height, height);
    for (std::size_t i = 0; i < rgb.size(); ++i)
      ASSERT_EQ(read.values[i / 3 * 4 + i % 3], static_cast<float>(value_of(rgb[i]))) << i;
  }
}

TEST(KnownSrgb, GivesTheBitsOfTheFunction) {
  KnownSrgb known;
  std::mt19937 random(3);
  std::vector<float> asked = {0.0f, -0.0f, 1.0f, std::nanf(""), -1.0f, 1e30f};
  for (int i = 0; i < 20000; ++i) asked.push_back(static_cast<float>(random() % 4096) / 3000.0f);
  for (const float value : asked)
    ASSERT_EQ(std::bit_cast<std::uint32_t>(known(value)),
              std::bit_cast<std::uint32_t>(srgb_from_linear(value)))
        << value;
}

}  // namespace
}  // namespace hwsim::pipeline
