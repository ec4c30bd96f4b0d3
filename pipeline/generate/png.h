#pragma once
// Writes the PNG files of generated textures.
#include <cstdint>
#include <vector>

namespace hwsim::pipeline::generate {

/// An 8-bit RGB or RGBA PNG, its data stored without compression (RFC 1951 block type 0): textures here are
/// small, and the bytes must not depend on a compressor's version. Texels have r in the lowest byte, row 0 on
/// top.
std::vector<std::uint8_t> encode_png(int width, int height, const std::vector<std::uint32_t>& texels,
                                     bool with_alpha = false);

}  // namespace hwsim::pipeline::generate
