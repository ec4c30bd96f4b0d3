#include "pipeline/image/heat_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "pipeline/image/metrics.h"

namespace hwsim::pipeline {
namespace {

/// The map's colors are meant as displayed: they are encoded after they were decoded, which changes a code
/// only where the value lies closer to the middle between two than the error of both (below 3e-4 of a code).
std::uint8_t code_of(float shown) {
  const float scaled = shown * 255.0f + 0.5f, whole = std::floor(scaled);
  if (std::abs(scaled - whole - 0.5f) < 0.499f) return static_cast<std::uint8_t>(whole);
  const float encoded = std::min(srgb_from_linear(linear_from_srgb(shown)), 1.0f);
  return static_cast<std::uint8_t>(encoded * 255.0f + 0.5f);
}

using Codes = std::array<std::uint8_t, 3>;

Codes codes_of(float value) {
  const glm::vec3 color = magma(value);
  return {code_of(color.x), code_of(color.y), code_of(color.z)};
}

}  // namespace

std::vector<std::uint8_t> heat_map(const Image& values, float full_scale) {
  std::vector<std::uint8_t> rgb(values.pixels.size() * 3);
  std::uint8_t* next = rgb.data();
  float last = 0.0f;
  Codes codes = codes_of(last / full_scale);
  for (const glm::vec4& pixel : values.pixels) {
    if (std::memcmp(&pixel.x, &last, sizeof last) != 0) {
      last = pixel.x;
      codes = codes_of(last / full_scale);
    }
    next = std::copy(codes.begin(), codes.end(), next);
  }
  return rgb;
}

}  // namespace hwsim::pipeline
