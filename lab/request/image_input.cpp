#include "lab/request/image_input.h"

#include <algorithm>
#include <array>
#include <span>

#include "hwsim/base/file_name.h"
#include "lab/base/files.h"
#include "pipeline/image/srgb_codes.h"

namespace hwsim::lab {
namespace {

using pipeline::RawImage;

bool is_linear(const std::string& path) { return has_extension(path, ".exr"); }

}  // namespace

bool is_image_file(const std::string& path) {
  constexpr std::array<std::string_view, 4> kEndings = {".png", ".jpg", ".jpeg", ".exr"};
  return std::any_of(kEndings.begin(), kEndings.end(),
                     [&](std::string_view e) { return has_extension(path, e); });
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
