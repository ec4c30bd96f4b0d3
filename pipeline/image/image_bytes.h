#pragma once
// Image files as bytes in memory.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/image/image.h"

namespace hwsim::pipeline {

/// As read_image of a path, of a file's bytes; `what` names the image in messages. Throws InputError.
Image read_image(std::span<const std::uint8_t> bytes, const std::string& what);

/// The bytes of the files that write_image writes.
std::vector<std::uint8_t> encode_png(const Image& image);
std::vector<std::uint8_t> encode_exr(const Image& image);

}  // namespace hwsim::pipeline
