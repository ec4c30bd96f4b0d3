#pragma once
// Depth is kept and compared as an integer: D16 and D24 by definition, D32F because the bits of floats in [0,
// 1] order as the floats do. So one integer comparison serves every format.
#include <bit>
#include <cstdint>

#include "hwsim/trace/format.h"

namespace hwsim::pipeline {

/// 65535 for D16, 2^24 - 1 for D24, 0 for the float formats.
constexpr float depth_scale(Format format) {
  switch (format) {
    case Format::d16_unorm:
      return 65535.0f;
    case Format::d24_unorm_s8:
      return 16777215.0f;
    default:
      return 0.0f;
  }
}

/// z in [0, 1]. Rounds to nearest, ties to even, in single precision, as the vector kernels do.
inline std::uint32_t depth_bits(float z, float scale) {
  if (scale == 0.0f) return std::bit_cast<std::uint32_t>(z + 0.0f);  // -0 becomes +0
  return static_cast<std::uint32_t>(__builtin_nearbyintf(z * scale));
}
inline float depth_value(std::uint32_t bits, float scale) {
  if (scale == 0.0f) return std::bit_cast<float>(bits);
  return static_cast<float>(bits) / scale;
}

}  // namespace hwsim::pipeline
