#include "lab/store/image_codec.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace hwsim::lab {
namespace {

using pipeline::Image;

constexpr std::size_t kChannels = 4;

}  // namespace

void encode_image(ByteWriter& out, const Image& image) {
  out.count(static_cast<std::uint64_t>(image.width));
  out.count(static_cast<std::uint64_t>(image.height));
  std::vector<float> plane(image.pixels.size());
  for (glm::length_t c = 0; c < static_cast<glm::length_t>(kChannels); ++c) {
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = image.pixels[i][c];
    const bool constant = std::all_of(plane.begin(), plane.end(), [&](const float& value) {
      return std::memcmp(&value, plane.data(), sizeof value) == 0;
    });
    out.count(constant ? 1 : 0);
    const std::size_t stored = constant ? std::min<std::size_t>(1, plane.size()) : plane.size();
    out.raw({reinterpret_cast<const std::uint8_t*>(plane.data()), stored * sizeof(float)});
  }
}

Image decode_image(ByteReader& in) {
  const std::uint64_t width = in.count(), height = in.count();
  constexpr std::uint64_t kMaxSide = 1 << 16;
  if (width > kMaxSide || height > kMaxSide) throw DamagedBytes("an image is too large");
  Image image(static_cast<int>(width), static_cast<int>(height));
  const std::size_t pixels = image.pixels.size();
  std::vector<float> plane(pixels);
  for (glm::length_t c = 0; c < static_cast<glm::length_t>(kChannels); ++c) {
    const bool constant = in.count() != 0;
    const std::size_t stored = constant ? std::min<std::size_t>(1, pixels) : pixels;
    const auto bytes = in.raw(stored * sizeof(float));
    std::memcpy(plane.data(), bytes.data(), bytes.size());
    for (std::size_t i = 0; i < pixels; ++i) image.pixels[i][c] = plane[constant ? 0 : i];
  }
  return image;
}

}  // namespace hwsim::lab
