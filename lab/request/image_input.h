#pragma once
// An image that stands for a scene: filters work on it, nothing is drawn.
#include <memory>
#include <string>

#include "pipeline/image/image_io.h"

namespace hwsim::lab {

/// By its ending: PNG, JPEG or OpenEXR.
bool is_image_file(const std::string& path);

struct ImageInput {
  std::shared_ptr<const pipeline::RawImage> texels;  ///< sRGB codes
  std::string content_hash;
};
/// Throws InputError when the file cannot be read or holds no image.
ImageInput read_image_input(const std::string& path);

}  // namespace hwsim::lab
