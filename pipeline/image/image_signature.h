#pragma once
// What an image file is, and whether all of it is there, before a library reads it.
#include <cstdint>
#include <span>

namespace hwsim::pipeline {

enum class ImageFormat { unknown, png, jpeg, exr };

/// By the first bytes: names lie, and a glTF buffer has none.
ImageFormat image_format(std::span<const std::uint8_t> bytes);

/// Whether a PNG's chunks reach its end and every critical one has its checksum. libpng would print to
/// stderr.
bool png_is_intact(std::span<const std::uint8_t> bytes);

/// Whether a JPEG's markers reach its end-of-image marker. libjpeg fills what is missing with gray and only
/// warns.
bool jpeg_is_complete(std::span<const std::uint8_t> bytes);

}  // namespace hwsim::pipeline
