#include "pipeline/image/metrics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "pipeline/image/channel.h"
#include "pipeline/image/flip.h"

namespace hwsim::pipeline {
namespace {

constexpr double kInfinitePsnrDb = 999.0;

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

Image srgb_encoded(Image image) {
  for (glm::vec4& pixel : image.pixels)
    for (int c = 0; c < 3; ++c) pixel[c] = srgb_from_linear(pixel[c]);
  return image;
}

double mean_squared_error(const Image& test, const Image& reference) {
  double sum = 0.0;
  for (std::size_t i = 0; i < test.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double difference =
          static_cast<double>(test.pixels[i][c]) - static_cast<double>(reference.pixels[i][c]);
      sum += difference * difference;
    }
  return sum / (3.0 * static_cast<double>(test.pixels.size()));
}

Channel luma_channel(const Image& image) {
  Channel channel(image.width, image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    channel.values[i] = 0.299f * image.pixels[i].x + 0.587f * image.pixels[i].y + 0.114f * image.pixels[i].z;
  return channel;
}

Channel product(const Channel& a, const Channel& b) {
  Channel out(a.width, a.height);
  for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] = a.values[i] * b.values[i];
  return out;
}

constexpr int kSsimRadiusPx = 5;

// Wang et al. 2004 average the windows that lie inside the image; images without one take all, borders
// repeated.
double structural_similarity(const Channel& a, const Channel& b) {
  const std::vector<float> taps = gaussian_taps(1.5, kSsimRadiusPx);
  const auto blur = [&](const Channel& in) { return filter_columns(filter_rows(in, taps), taps); };
  const Channel mean_a = blur(a), mean_b = blur(b), aa = blur(product(a, a)), bb = blur(product(b, b)),
                ab = blur(product(a, b));
  const bool has_inside = std::min(a.width, a.height) > 2 * kSsimRadiusPx;
  const int margin = has_inside ? kSsimRadiusPx : 0;
  constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
  double sum = 0.0;
  for (int y = margin; y < a.height - margin; ++y)
    for (int x = margin; x < a.width - margin; ++x) {
      const double ma = mean_a.row(y)[x], mb = mean_b.row(y)[x];
      const double va = aa.row(y)[x] - ma * ma, vb = bb.row(y)[x] - mb * mb, cov = ab.row(y)[x] - ma * mb;
      sum += (2.0 * ma * mb + c1) * (2.0 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
    }
  return sum / (static_cast<double>(a.width - 2 * margin) * static_cast<double>(a.height - 2 * margin));
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

std::string size_text(const Image& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height);
}

}  // namespace

ImageError compare(const Image& test, const Image& reference, Image* flip_map) {
  if (test.width != reference.width || test.height != reference.height)
    throw std::invalid_argument("image sizes differ: " + size_text(test) + " and " + size_text(reference));
  if (test.pixels.empty()) throw std::invalid_argument("the images are empty");
  const Image shown_test = displayed(test), shown_reference = displayed(reference);
  const Image encoded_test = srgb_encoded(shown_test), encoded_reference = srgb_encoded(shown_reference);
  ImageError error;
  const double squared = mean_squared_error(encoded_test, encoded_reference);
  error.rmse = std::sqrt(squared);
  error.psnr_db = squared > 0.0 ? std::min(kInfinitePsnrDb, -10.0 * std::log10(squared)) : kInfinitePsnrDb;
  error.ssim = structural_similarity(luma_channel(encoded_test), luma_channel(encoded_reference));
  Channel flip = flip_error(shown_test, shown_reference);
  if (flip_map) {
    *flip_map = Image(test.width, test.height, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    for (std::size_t i = 0; i < flip.values.size(); ++i) flip_map->pixels[i].x = flip.values[i];
  }
  add_flip(error, std::move(flip));
  return error;
}

}  // namespace hwsim::pipeline
