#include <algorithm>
#include <array>

#include "pipeline/image/metrics.h"

namespace hwsim::pipeline {

glm::vec3 magma(float value) {
  // Every 32nd color of the map by van der Walt and Smith (CC0), sRGB; between them the lightness is near to
  // linear.
  static constexpr std::array<std::array<float, 3>, 9> knots = {{{0x00, 0x00, 0x04},
                                                                 {0x1D, 0x11, 0x47},
                                                                 {0x51, 0x12, 0x7C},
                                                                 {0x82, 0x26, 0x81},
                                                                 {0xB6, 0x36, 0x79},
                                                                 {0xE6, 0x51, 0x64},
                                                                 {0xFB, 0x88, 0x61},
                                                                 {0xFE, 0xC2, 0x87},
                                                                 {0xFC, 0xFD, 0xBF}}};
  const float position = value > 0.0f ? std::min(value, 1.0f) * 8.0f : 0.0f;  // NaN is 0
  const auto left = std::min(static_cast<std::size_t>(position), knots.size() - 2);
  const float t = position - static_cast<float>(left);
  glm::vec3 linear;
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    linear[c] = linear_from_srgb(((1.0f - t) * knots[left][channel] + t * knots[left + 1][channel]) / 255.0f);
  }
  return linear;
}

}  // namespace hwsim::pipeline
