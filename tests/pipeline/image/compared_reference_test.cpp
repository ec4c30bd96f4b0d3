// What is found once of a reference, and heat maps: the same numbers as found each time.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "pipeline/image/heat_map.h"
#include "pipeline/image/metrics.h"

namespace hwsim::pipeline {
namespace {

Image noise(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  Image image(width, height);
  for (glm::vec4& pixel : image.pixels)
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(random() % 1000) / 800.0f;
  return image;
}

TEST(ComparedReference, GivesTheSameForAnyNumberOfThreadsAndComparisons) {
  for (const auto& [width, height] : {std::pair(1, 1), {5, 70}, {67, 35}}) {
    const Image reference = noise(width, height, 1);
    const ComparedReference once(reference, 1), threads(reference, 3);
    for (const unsigned seed : {2u, 3u}) {
      const Image test = noise(width, height, seed);
      Image map, map_once, map_threads;
      const ImageError a = compare(test, reference, &map), b = once.error_of(test, &map_once),
                       c = threads.error_of(test, &map_threads);
      EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
      EXPECT_EQ(std::memcmp(&a, &c, sizeof a), 0);
      EXPECT_EQ(map.pixels, map_once.pixels);
      EXPECT_EQ(map.pixels, map_threads.pixels);
    }
  }
}

// The colors are meant as displayed: decoded, and encoded again by whoever writes a picture.
TEST(HeatMap, IsWhatEncodingTheMapsColorsGives) {
  std::mt19937 random(5);
  Image values(1000, 100);
  for (glm::vec4& pixel : values.pixels) pixel.x = static_cast<float>(random()) / 3e9f;
  values.pixels[0].x = std::nanf("");
  values.pixels[1].x = -1.0f;
  for (const float scale : {1.0f, 0.7f, 13.0f}) {
    const std::vector<std::uint8_t> codes = heat_map(values, scale);
    for (std::size_t i = 0; i < values.pixels.size(); ++i) {
      const glm::vec3 shown = magma(values.pixels[i].x / scale);
      for (int c = 0; c < 3; ++c) {
        const float encoded = std::min(srgb_from_linear(linear_from_srgb(shown[c])), 1.0f);
        ASSERT_EQ(codes[3 * i + static_cast<std::size_t>(c)],
                  static_cast<std::uint8_t>(encoded * 255.0f + 0.5f));
      }
    }
  }
}

}  // namespace
}  // namespace hwsim::pipeline
