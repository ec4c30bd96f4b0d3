#pragma once
// Image files. What is no plain PNG is decoded by OpenImageIO. It takes 0.26 s to load into a process, so it
// sits in a module of its own (libhwsim_image_io.so), opened when it is first needed; nothing else of the
// project includes or links it.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/image/image.h"

namespace hwsim::pipeline {

/// 8-bit texels, r in the lowest byte, row 0 on top, as stored (no color conversion, no premultiplication).
struct RawImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> texels;
};

/// From a file's bytes (PNG or JPEG). Throws InputError with `what` naming the image.
RawImage decode_image(std::span<const std::uint8_t> bytes, const std::string& what);

/// Reads a PNG, JPEG or EXR file to linear RGBA. Throws InputError.
Image read_image(const std::string& path);

/// .png: sRGB 8 bit, RGB; .exr: half-float linear RGB. Written beside the target and renamed, so that a file
/// that exists is complete. Throws InputError if the folder cannot be written.
void write_image(const Image& image, const std::string& path);

}  // namespace hwsim::pipeline
