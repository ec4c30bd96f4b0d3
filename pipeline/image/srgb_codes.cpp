#include "pipeline/image/srgb_codes.h"

#include <algorithm>
#include <cmath>

namespace hwsim::pipeline {
namespace {

constexpr int kColors = 3;
constexpr float kLargestCode = 255.0f;

}  // namespace

RawImage srgb_codes(const Image& linear) {
  RawImage raw;
  raw.width = linear.width;
  raw.height = linear.height;
  raw.texels.reserve(linear.pixels.size());
  for (const glm::vec4& p : linear.pixels) {
    std::uint32_t texel = 0xff000000u;
    for (int c = 0; c < kColors; ++c) {
      const float encoded = std::clamp(srgb_from_linear(p[c]), 0.0f, 1.0f);
      texel |= static_cast<std::uint32_t>(std::lround(encoded * kLargestCode)) << (8 * c);
    }
    raw.texels.push_back(texel);
  }
  return raw;
}

Image linear_image(const RawImage& codes) {
  Image image(codes.width, codes.height, glm::vec4(1.0f));
  for (std::size_t i = 0; i < codes.texels.size(); ++i)
    for (int c = 0; c < kColors; ++c)
      image.pixels[i][c] =
          linear_from_srgb(static_cast<float>(codes.texels[i] >> (8 * c) & 0xffu) / kLargestCode);
  return image;
}

}  // namespace hwsim::pipeline
