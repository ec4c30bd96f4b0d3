#pragma once
// PNG files: all that are written, and those that are read most.
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "pipeline/image/image_io.h"

namespace hwsim::pipeline {

/// 8-bit RGB, rows from the top.
std::vector<std::uint8_t> encode_png(int width, int height, std::span<const std::uint8_t> rgb);

/// 8-bit gray or RGB, with or without alpha, not interlaced, no color that stands for transparency. None: it
/// is another one, or damaged, and the image module decides.
std::optional<RawImage> decode_plain_png(std::span<const std::uint8_t> bytes);

/// For who puts a file together: its first bytes, and a chunk with length and checksum.
void append_png_signature(std::vector<std::uint8_t>& out);
void append_png_chunk(std::vector<std::uint8_t>& out, std::string_view type,
                      std::span<const std::uint8_t> data);

}  // namespace hwsim::pipeline
