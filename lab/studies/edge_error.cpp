#include "lab/studies/edge_error.h"

#include <algorithm>
#include <cmath>

#include "pipeline/image/channel.h"

namespace hwsim::lab {
namespace {

constexpr float kStep = 1.0f / 16.0f;
constexpr double kEqualDb = 999.0;

glm::vec3 shown(const glm::vec4& linear) {
  glm::vec3 color;
  for (glm::length_t c = 0; c < 3; ++c)
    color[c] = std::clamp(pipeline::srgb_from_linear(linear[c]), 0.0f, 1.0f);
  return color;
}

std::vector<char> grown(const std::vector<char>& mask, int width, int height) {
  std::vector<char> result = mask;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      if (!mask[at]) continue;
      if (x > 0) result[at - 1] = 1;
      if (x + 1 < width) result[at + 1] = 1;
      if (y > 0) result[at - static_cast<std::size_t>(width)] = 1;
      if (y + 1 < height) result[at + static_cast<std::size_t>(width)] = 1;
    }
  return result;
}

}  // namespace

std::vector<char> edge_mask(const pipeline::Image& reference) {
  const auto width = static_cast<std::size_t>(reference.width);
  std::vector<float> luma;
  for (const glm::vec4& pixel : reference.pixels)
    luma.push_back(glm::dot(shown(pixel), glm::vec3(0.2126f, 0.7152f, 0.0722f)));
  std::vector<char> mask(luma.size(), 0);
  const auto compare = [&](std::size_t a, std::size_t b) {
    if (std::abs(luma[a] - luma[b]) > kStep) mask[a] = mask[b] = 1;
  };
  for (std::size_t i = 0; i < luma.size(); ++i) {
    if ((i + 1) % width != 0) compare(i, i + 1);
    if (i + width < luma.size()) compare(i, i + width);
  }
  return grown(mask, reference.width, reference.height);
}

EdgeError edge_error(const pipeline::Image& image, const pipeline::Image& reference,
                     const pipeline::Image& flip_map, const std::vector<char>& mask) {
  double flip = 0.0, squares = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (!mask[i]) continue;
    ++count;
    flip += static_cast<double>(flip_map.pixels[i].x);
    const glm::vec3 difference = shown(image.pixels[i]) - shown(reference.pixels[i]);
    squares += static_cast<double>(glm::dot(difference, difference)) / 3.0;
  }
  if (count == 0 || squares == 0.0) return {count ? flip / static_cast<double>(count) : 0.0, kEqualDb};
  return {flip / static_cast<double>(count), -10.0 * std::log10(squares / static_cast<double>(count))};
}

}  // namespace hwsim::lab
