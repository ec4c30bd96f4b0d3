#pragma once
// OpenEXR files as they are written: three half floats a pixel, compressed by 16 rows.
#include <cstdint>
#include <span>
#include <vector>

namespace hwsim::pipeline {

/// The nearest half float, ties to even; beyond the largest, infinity.
std::uint16_t half_from_float(float value);

/// Rows from the top, r, g, b.
std::vector<std::uint8_t> encode_exr_halves(int width, int height, std::span<const std::uint16_t> rgb);

}  // namespace hwsim::pipeline
