#include "lab/request/image_input.h"

#include <algorithm>
#include <array>
#include <span>

#include "lab/base/files.h"
#include "pipeline/image/srgb_codes.h"

namespace hwsim::lab {
namespace {

using pipeline::RawImage;

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
    raw = pipeline::srgb_codes(pipeline::read_image(path));
  else
    raw = pipeline::decode_image({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, path);
  input.texels = std::make_shared<const RawImage>(std::move(raw));
  return input;
}

}  // namespace hwsim::lab
