#include "pipeline/image/metrics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/image/channel.h"
#include "pipeline/image/flip.h"
#include "pipeline/image/known_srgb.h"

namespace hwsim::pipeline {
namespace {

constexpr double kInfinitePsnrDb = 999.0;
constexpr std::size_t kColors = 3;

// What a display shows: NaN and negative values are black, as write_image stores them.
Image displayed(const Image& image) {
  Image out(image.width, image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const float value = image.pixels[i][c];
      out.pixels[i][c] = value > 0.0f ? std::min(value, 1.0f) : 0.0f;
    }
  return out;
}

/// Red, green and blue of each pixel.
std::vector<float> srgb_encoded(const Image& image) {
  KnownSrgb encoded;
  std::vector<float> out;
  out.reserve(image.pixels.size() * kColors);
  for (const glm::vec4& pixel : image.pixels)
    for (glm::length_t c = 0; c < 3; ++c) out.push_back(encoded(pixel[c]));
  return out;
}

double mean_squared_error(const std::vector<float>& test, const std::vector<float>& reference) {
  double sum = 0.0;
  for (std::size_t i = 0; i < test.size(); ++i) {
    const double difference = static_cast<double>(test[i]) - static_cast<double>(reference[i]);
    sum += difference * difference;
  }
  return sum / static_cast<double>(test.size());
}

Channel luma_channel(const Image& image, const std::vector<float>& encoded) {
  Channel channel(image.width, image.height);
  for (std::size_t i = 0; i < channel.values.size(); ++i)
    channel.values[i] =
        0.299f * encoded[kColors * i] + 0.587f * encoded[kColors * i + 1] + 0.114f * encoded[kColors * i + 2];
  return channel;
}

Channel product(const Channel& a, const Channel& b) {
  Channel out(a.width, a.height);
  for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] = a.values[i] * b.values[i];
  return out;
}

constexpr int kSsimRadiusPx = 5;

Channel blurred(const Channel& in, int jobs) {
  const std::vector<float> taps = gaussian_taps(1.5, kSsimRadiusPx);
  return filter_columns(filter_rows(in, taps, jobs), taps, jobs);
}

struct SsimSide {
  Channel luma, mean, square;
  SsimSide(Channel its_luma, int jobs)
      : luma(std::move(its_luma)), mean(blurred(luma, jobs)), square(blurred(product(luma, luma), jobs)) {}
};

// Wang et al. 2004 average the windows that lie inside the image; images without one take all, borders
// repeated.
double structural_similarity(const SsimSide& a, const SsimSide& b, int jobs) {
  const Channel both = blurred(product(a.luma, b.luma), jobs);
  const int width = both.width, height = both.height;
  const bool has_inside = std::min(width, height) > 2 * kSsimRadiusPx;
  const int margin = has_inside ? kSsimRadiusPx : 0;
  constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
  double sum = 0.0;
  for (int y = margin; y < height - margin; ++y)
    for (int x = margin; x < width - margin; ++x) {
      const double ma = a.mean.row(y)[x], mb = b.mean.row(y)[x];
      const double va = a.square.row(y)[x] - ma * ma, vb = b.square.row(y)[x] - mb * mb,
                   cov = both.row(y)[x] - ma * mb;
      sum += (2.0 * ma * mb + c1) * (2.0 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
    }
  return sum / (static_cast<double>(width - 2 * margin) * static_cast<double>(height - 2 * margin));
}

// The smallest value that at least `share` of all values do not exceed.
double quantile(std::vector<float>& values, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

void add_flip(ImageError& error, Channel flip) {
  double sum = 0.0;
  for (const float value : flip.values) sum += value;
  error.flip_mean = sum / static_cast<double>(flip.values.size());
  error.flip_median = quantile(flip.values, 0.5);
  error.flip_p99 = quantile(flip.values, 0.99);
}

std::string size_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

struct ComparedReference::Sides {
  int width, height;
  std::vector<float> encoded;
  SsimSide ssim;
  FlipSide flip;

  Sides(const Image& image, int jobs) : Sides(image, displayed(image), jobs) {}
  Sides(const Image& image, const Image& shown, int jobs)
      : width(image.width),
        height(image.height),
        encoded(srgb_encoded(shown)),
        ssim(luma_channel(shown, encoded), jobs),
        flip(flip_side(shown, jobs)) {}
};

ComparedReference::ComparedReference(const Image& reference, int jobs)
    : sides_(std::make_unique<const Sides>(reference, jobs)), jobs_(jobs) {}
ComparedReference::~ComparedReference() = default;
ComparedReference::ComparedReference(ComparedReference&&) noexcept = default;

ImageError ComparedReference::error_of(const Image& image, Image* flip_map) const {
  if (image.width != sides_->width || image.height != sides_->height)
    throw std::invalid_argument("image sizes differ: " + size_text(image.width, image.height) + " and " +
                                size_text(sides_->width, sides_->height));
  if (image.pixels.empty()) throw std::invalid_argument("the images are empty");
  const Sides test(image, jobs_);
  ImageError error;
  const double squared = mean_squared_error(test.encoded, sides_->encoded);
  error.rmse = std::sqrt(squared);
  error.psnr_db = squared > 0.0 ? std::min(kInfinitePsnrDb, -10.0 * std::log10(squared)) : kInfinitePsnrDb;
  error.ssim = structural_similarity(test.ssim, sides_->ssim, jobs_);
  Channel flip = flip_error(test.flip, sides_->flip, jobs_);
  if (flip_map) {
    *flip_map = Image(image.width, image.height, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    for (std::size_t i = 0; i < flip.values.size(); ++i) flip_map->pixels[i].x = flip.values[i];
  }
  add_flip(error, std::move(flip));
  return error;
}

ImageError compare(const Image& test, const Image& reference, Image* flip_map) {
  return ComparedReference(reference).error_of(test, flip_map);
}

}  // namespace hwsim::pipeline
