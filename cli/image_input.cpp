#include "cli/image_input.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "cli/files.h"

namespace hwsim::cli {
namespace {

using pipeline::Image;
using pipeline::RawImage;

std::uint32_t code(float linear, int shift) {
  const float encoded = std::clamp(pipeline::srgb_from_linear(linear), 0.0f, 1.0f);
  return static_cast<std::uint32_t>(std::lround(encoded * 255.0f)) << shift;
}

RawImage encoded(const Image& image) {
  RawImage raw;
  raw.width = image.width;
  raw.height = image.height;
  for (const glm::vec4& p : image.pixels)
    raw.texels.push_back(code(p.x, 0) | code(p.y, 8) | code(p.z, 16) | 0xff000000u);
  return raw;
}

bool is_linear(const std::string& path) { return path.ends_with(".exr") || path.ends_with(".EXR"); }

}  // namespace

bool is_image_file(const std::string& path) {
  constexpr std::array<std::string_view, 8> kEndings = {".png",  ".PNG",  ".jpg", ".JPG",
                                                        ".jpeg", ".JPEG", ".exr", ".EXR"};
  return std::any_of(kEndings.begin(), kEndings.end(), [&](std::string_view e) { return path.ends_with(e); });
}

ImageInput read_image_input(const std::string& path) {
  const std::string bytes = read_file(path);
  ImageInput input;
  input.content_hash = hash_hex(bytes);
  RawImage raw;
  if (is_linear(path))
    raw = encoded(pipeline::read_image(path));
  else
    raw = pipeline::decode_image({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, path);
  input.texels = std::make_shared<const RawImage>(std::move(raw));
  return input;
}

}  // namespace hwsim::cli
