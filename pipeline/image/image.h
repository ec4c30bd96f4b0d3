#pragma once
// A picture in memory, and the sRGB transfer functions.
#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace hwsim::pipeline {

/// Linear RGBA, row-major, row 0 on top.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<glm::vec4> pixels;

  Image() = default;
  Image(int w, int h, glm::vec4 fill = glm::vec4(0.0f))
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), fill) {}
  glm::vec4& at(int x, int y) { return pixels[index(x, y)]; }
  const glm::vec4& at(int x, int y) const { return pixels[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// The sRGB transfer functions, IEC 61966-2-1.
float srgb_from_linear(float linear);
float linear_from_srgb(float encoded);
/// linear_from_srgb of each 8-bit code; textures and render targets share it.
const std::array<float, 256>& srgb_decode_table();

}  // namespace hwsim::pipeline
