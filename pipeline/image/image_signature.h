#pragma once
// What an image file is, and whether all of it is there, before a library reads it.
#include <cstddef>
#include <cstdint>
#include <span>

namespace hwsim::pipeline {

enum class ImageFormat { unknown, png, jpeg, exr };

/// By the first bytes: names lie, and a glTF buffer has none.
ImageFormat image_format(std::span<const std::uint8_t> bytes);

struct ImageSize {
  std::uint32_t width = 0, height = 0;  ///< px
};
/// What a PNG's or JPEG's header says, without decoding anything; zeros where there is no such header.
ImageSize image_size(std::span<const std::uint8_t> bytes);

/// Whether a PNG's chunks reach its end and every critical one has its checksum. libpng would print to
/// stderr.
bool png_is_intact(std::span<const std::uint8_t> bytes);

/// Whether a PNG's compressed bytes are no more than twice what its pixels could be: deflate makes nothing
/// longer, and what comes behind the last pixel is unpacked, too.
bool png_data_fits(std::span<const std::uint8_t> bytes);

/// Scans of a complete JPEG; 0 of others.
std::size_t jpeg_scans(std::span<const std::uint8_t> bytes);

/// Whether a JPEG's markers reach its end-of-image marker. libjpeg fills what is missing with gray and only
/// warns.
bool jpeg_is_complete(std::span<const std::uint8_t> bytes);

}  // namespace hwsim::pipeline
