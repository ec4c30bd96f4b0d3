#include "pipeline/image/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "pipeline/image/flip.h"

namespace hwsim::pipeline {
namespace {

Image noise(int width, int height, std::uint32_t seed) {
  std::mt19937 generator(seed);
  Image image(width, height);
  for (glm::vec4& pixel : image.pixels)
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(generator() & 0xFFFF) / 65535.0f;
  return image;
}

Image with_noise(Image image, float amplitude) {
  const Image added = noise(image.width, image.height, 99);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = glm::clamp(image.pixels[i] + amplitude * (added.pixels[i] - 0.5f), 0.0f, 1.0f);
  return image;
}

Image gradient(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at(x, y) = {static_cast<float>(x) / static_cast<float>(width), 0.3f,
                        static_cast<float>(y) / static_cast<float>(height), 1.0f};
  return image;
}

// ---- FLIP again, in doubles, with two-dimensional kernels summed directly: the paper's text without
// separability.
using Vec = std::array<double, 3>;
constexpr Vec kWhite{0.4124564 + 0.3575761 + 0.1804375, 1.0, 0.0193339 + 0.1191920 + 0.9503041};

Vec xyz(Vec c) {
  return {0.4124564 * c[0] + 0.3575761 * c[1] + 0.1804375 * c[2],
          0.2126729 * c[0] + 0.7151522 * c[1] + 0.0721750 * c[2],
          0.0193339 * c[0] + 0.1191920 * c[1] + 0.9503041 * c[2]};
}

Vec opponent(const glm::vec4& p) {
  const Vec v = xyz({p.x, p.y, p.z});
  const double x = v[0] / kWhite[0], y = v[1] / kWhite[1], z = v[2] / kWhite[2];
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Vec hunt_lab(Vec linear) {
  const auto f = [](double t) { return t > 216.0 / 24389.0 ? std::cbrt(t) : t * 841.0 / 108.0 + 4.0 / 29.0; };
  const Vec v = xyz(linear);
  const double x = f(v[0] / kWhite[0]), y = f(v[1] / kWhite[1]), z = f(v[2] / kWhite[2]);
  const double lightness = 116 * y - 16;
  return {lightness, 5 * lightness * (x - y), 2 * lightness * (y - z)};
}

double distance(Vec p, Vec q) {
  return std::pow(std::abs(p[0] - q[0]) + std::hypot(p[1] - q[1], p[2] - q[2]), 0.7);
}

double color_error(Vec p, Vec q) {
  const double largest = distance(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), knee = 0.4 * largest;
  const double d = distance(hunt_lab(p), hunt_lab(q));
  return d < knee ? 0.95 / knee * d : 0.95 + (d - knee) / (largest - knee) * 0.05;
}

template <class Kernel>
double sum_2d(const Image& image, int px, int py, int channel, int radius, Kernel kernel) {
  double sum = 0, positive = 0, negative = 0, result_positive = 0, result_negative = 0;
  for (int dy = -radius; dy <= radius; ++dy)
    for (int dx = -radius; dx <= radius; ++dx) {
      const int x = std::clamp(px + dx, 0, image.width - 1), y = std::clamp(py + dy, 0, image.height - 1);
      const double w = kernel(dx, dy), value = opponent(image.at(x, y))[static_cast<std::size_t>(channel)];
      sum += w;
      (w > 0 ? positive : negative) += std::abs(w);
      (w > 0 ? result_positive : result_negative) += w * value;
    }
  return negative > 0 ? result_positive / positive + result_negative / negative : result_positive / sum;
}

Vec direct_filtered(const Image& image, int x, int y) {
  const auto kernel = [](double a1, double b1, double a2, double b2) {
    return [=](int dx, int dy) {
      const double pi = std::numbers::pi, d2 = (dx * dx + dy * dy) / std::pow(kFlipPixelsPerDegree, 2);
      return a1 * std::sqrt(pi / b1) * std::exp(-pi * pi * d2 / b1) +
             a2 * std::sqrt(pi / b2) * std::exp(-pi * pi * d2 / b2);
    };
  };
  const double l = (sum_2d(image, x, y, 0, 10, kernel(1, 0.0047, 0, 1e-5)) + 16) / 116;
  const double cx = sum_2d(image, x, y, 1, 10, kernel(1, 0.0053, 0, 1e-5));
  const double cz = sum_2d(image, x, y, 2, 10, kernel(34.1, 0.04, 13.5, 0.025));
  const Vec v = {(l + cx / 500) * kWhite[0], l, (l - cz / 200) * kWhite[2]};
  Vec rgb = {3.2404542 * v[0] - 1.5371385 * v[1] - 0.4985314 * v[2],
             -0.9692660 * v[0] + 1.8760108 * v[1] + 0.0415560 * v[2],
             0.0556434 * v[0] - 0.2040259 * v[1] + 1.0572252 * v[2]};
  for (double& c : rgb) c = std::clamp(c, 0.0, 1.0);
  return rgb;
}

double direct_feature(const Image& image, int x, int y, int order) {
  const double sigma = 0.5 * 0.082 * kFlipPixelsPerDegree;
  const auto along = [&](bool horizontal) {
    return sum_2d(image, x, y, 0, 9, [&](int dx, int dy) {
      const double u = horizontal ? dx : dy, g = std::exp(-(dx * dx + dy * dy) / (2 * sigma * sigma));
      return order == 1 ? -u * g : (u * u / (sigma * sigma) - 1) * g;
    });
  };
  return std::hypot(along(true), along(false)) / 116;
}

double direct_flip(const Image& test, const Image& reference, int x, int y) {
  double feature = 0;
  for (const int order : {1, 2})
    feature = std::max(feature,
                       std::abs(direct_feature(test, x, y, order) - direct_feature(reference, x, y, order)));
  const double color = color_error(direct_filtered(test, x, y), direct_filtered(reference, x, y));
  return std::pow(color, 1 - std::sqrt(feature / std::numbers::sqrt2));
}

TEST(Compare, FindsNoErrorBetweenEqualImages) {
  const Image image = noise(40, 30, 1);
  const ImageError error = compare(image, image);
  EXPECT_EQ(error.psnr_db, 999.0);
  EXPECT_EQ(error.rmse, 0.0);
  EXPECT_NEAR(error.ssim, 1.0, 1e-9);
  EXPECT_EQ(error.flip_mean, 0.0);
  EXPECT_EQ(error.flip_p99, 0.0);
}

TEST(Compare, MeasuresPsnrAndRmseOfEncodedValues) {
  const auto gray = [](float encoded) { return glm::vec4(glm::vec3(linear_from_srgb(encoded)), 1.0f); };
  Image test(16, 16, gray(0.6f)), reference(16, 16, gray(0.5f));
  EXPECT_NEAR(compare(test, reference).rmse, 0.1, 1e-6);
  EXPECT_NEAR(compare(test, reference).psnr_db, 20.0, 1e-4);
  for (int x = 0; x < 16; ++x)
    for (int y = 0; y < 12; ++y) test.at(x, y) = reference.at(x, y);
  EXPECT_NEAR(compare(test, reference).rmse, 0.05, 1e-6);
}

TEST(Compare, MeasuresSsimOfConstantImagesByTheLuminanceTermAlone) {
  const auto gray = [](float encoded) { return glm::vec4(glm::vec3(linear_from_srgb(encoded)), 1.0f); };
  const double a = 0.8, b = 0.4, c1 = 1e-4;
  for (const int size : {4, 32})
    EXPECT_NEAR(compare(Image(size, size, gray(0.8f)), Image(size, size, gray(0.4f))).ssim,
                (2 * a * b + c1) / (a * a + b * b + c1), 2e-3);
  const double inverted = compare(noise(64, 64, 3), with_noise(noise(64, 64, 3), 0.0f)).ssim;
  EXPECT_NEAR(inverted, 1.0, 1e-9);
  Image negative = noise(64, 64, 3);
  for (glm::vec4& pixel : negative.pixels) pixel = 1.0f - pixel;
  EXPECT_LT(compare(negative, noise(64, 64, 3)).ssim, -0.5);
}

TEST(Flip, OfConstantImagesIsTheRemappedColorDistance) {
  const std::vector<std::pair<glm::vec4, glm::vec4>> pairs = {{{0, 0, 0, 1}, {1, 1, 1, 1}},
                                                              {{0, 1, 0, 1}, {0, 0, 1, 1}},
                                                              {{0.2f, 0.2f, 0.2f, 1}, {0.22f, 0.2f, 0.2f, 1}},
                                                              {{0.5f, 0.1f, 0.7f, 1}, {0.4f, 0.3f, 0.1f, 1}}};
  for (const auto& [p, q] : pairs) {
    const ImageError error = compare(Image(30, 20, p), Image(30, 20, q));
    const double expected = color_error({p.x, p.y, p.z}, {q.x, q.y, q.z});
    EXPECT_NEAR(error.flip_mean, expected, 1e-4);
    EXPECT_NEAR(error.flip_median, expected, 1e-4);
    EXPECT_NEAR(error.flip_p99, expected, 1e-4);
  }
  // White on black: L differs by 100 and chroma not, 100^0.7 above the knee.
  EXPECT_NEAR(compare(Image(30, 20, glm::vec4(0)), Image(30, 20, glm::vec4(1))).flip_mean, 0.9674, 2e-4);
  EXPECT_NEAR(compare(Image(9, 9, {0, 1, 0, 1}), Image(9, 9, {0, 0, 1, 1})).flip_mean, 1.0, 1e-5);
}

TEST(Flip, EqualsTheDirectSumsOfThePaper) {
  const Image test = noise(23, 19, 5), reference = gradient(23, 19);
  Image map;
  compare(test, reference, &map);
  for (const glm::ivec2 p :
       {glm::ivec2(0, 0), glm::ivec2(22, 18), glm::ivec2(11, 9), glm::ivec2(3, 17), glm::ivec2(20, 2)})
    EXPECT_NEAR(map.at(p.x, p.y).x, direct_flip(test, reference, p.x, p.y), 2e-4) << p.x << " " << p.y;
}

TEST(Flip, IsSymmetricAndTurnsWithTheImages) {
  const Image a = noise(20, 20, 1), b = with_noise(a, 0.7f);
  EXPECT_NEAR(compare(a, b).flip_mean, compare(b, a).flip_mean, 1e-9);
  Image at(20, 20), bt(20, 20), map, map_t;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) {
      at.at(y, x) = a.at(x, y);
      bt.at(y, x) = b.at(x, y);
    }
  compare(a, b, &map);
  compare(at, bt, &map_t);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) EXPECT_NEAR(map.at(x, y).x, map_t.at(y, x).x, 1e-4);
}

TEST(Flip, StaysInRangeAndGrowsWithNoise) {
  const Image reference = gradient(64, 48);
  double last = 0.0;
  for (const float amplitude : {0.02f, 0.1f, 0.3f, 0.6f, 1.0f, 2.0f}) {
    Image map;
    const ImageError error = compare(with_noise(reference, amplitude), reference, &map);
    EXPECT_GT(error.flip_mean, last);
    EXPECT_LE(error.flip_median, error.flip_p99);
    last = error.flip_mean;
    for (const glm::vec4& pixel : map.pixels) {
      EXPECT_GE(pixel.x, 0.0f);
      EXPECT_LE(pixel.x, 1.0f);
    }
  }
}

TEST(Compare, TakesNanAndNegativePixelsAsBlackAndInfiniteOnesAsWhite) {
  const Image reference(32, 32, glm::vec4(0, 0, 0, 1));
  Image test = reference, white = reference;
  test.at(3, 3) = glm::vec4(std::numeric_limits<float>::quiet_NaN());
  test.at(9, 3) = glm::vec4(-5.0f);
  EXPECT_EQ(compare(test, reference).flip_mean, 0.0);
  test.at(20, 20) = glm::vec4(std::numeric_limits<float>::infinity());
  white.at(20, 20) = glm::vec4(1.0f);
  const ImageError error = compare(test, reference);
  EXPECT_TRUE(std::isfinite(error.flip_mean) && std::isfinite(error.psnr_db) && std::isfinite(error.ssim));
  EXPECT_EQ(error.flip_mean, compare(white, reference).flip_mean);
  EXPECT_GT(error.flip_mean, 0.0);
}

TEST(Compare, RefusesImagesOfDifferentSizesAndEmptyOnes) {
  EXPECT_THROW(compare(Image(2, 3), Image(3, 2)), std::invalid_argument);
  EXPECT_THROW(compare(Image(), Image()), std::invalid_argument);
}

TEST(Compare, TakesASinglePixel) {
  EXPECT_NEAR(compare(Image(1, 1, glm::vec4(0)), Image(1, 1, glm::vec4(1))).flip_mean, 0.9674, 2e-4);
}

TEST(Compare, ReportsNearestRankQuantiles) {
  Image test(200, 200), reference(200, 200);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x)
      if (x < 4) test.at(x, y) = glm::vec4(1.0f);  // 2 % of the pixels, more by blurring, fewer than a half
  const ImageError error = compare(test, reference);
  EXPECT_EQ(error.flip_median, 0.0);
  EXPECT_GT(error.flip_p99, 0.5);
}

TEST(Magma, RunsFromBlackToPaleYellowAndGetsLighter) {
  EXPECT_NEAR(srgb_from_linear(magma(0.5f).x), 0.716387, 0.003);  // matplotlib's value
  EXPECT_NEAR(srgb_from_linear(magma(1.0f).y), 0.991438, 0.003);
  EXPECT_EQ(magma(std::numeric_limits<float>::quiet_NaN()), magma(0.0f));
  EXPECT_EQ(magma(7.0f), magma(1.0f));
  const auto luminance = [](glm::vec3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; };
  for (float v = 0.0f; v < 1.0f; v += 1.0f / 64.0f)
    EXPECT_LT(luminance(magma(v)), luminance(magma(v + 1.0f / 64.0f)));
}

}  // namespace
}  // namespace hwsim::pipeline
