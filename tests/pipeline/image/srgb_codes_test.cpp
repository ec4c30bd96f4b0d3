#include "pipeline/image/srgb_codes.h"

#include <gtest/gtest.h>

namespace hwsim::pipeline {
namespace {

TEST(SrgbCodes, EveryCodeComesBack) {
  RawImage codes{16, 16, {}};
  for (std::uint32_t code = 0; code < 256; ++code)
    codes.texels.push_back(0xff000000u | code | (255u - code) << 8 | (code ^ 0x5au) << 16);
  const RawImage again = srgb_codes(linear_image(codes));
  EXPECT_EQ(again.width, 16);
  EXPECT_EQ(again.texels, codes.texels);
}

TEST(SrgbCodes, WhatNoCodeHoldsIsClamped) {
  Image image(2, 1);
  image.pixels = {{-1.0f, 0.0f, 7.0f, 0.25f}, {0.5f, 1.0f, 0.0f, 1.0f}};
  // IEC 61966-2-1 by hand: 0.5 linear is 0.735 encoded, code 188
  EXPECT_EQ(srgb_codes(image).texels, (std::vector<std::uint32_t>{0xffff0000u, 0xff00ffbcu}));
}

}  // namespace
}  // namespace hwsim::pipeline
