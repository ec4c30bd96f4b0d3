#include "lab/results/contact_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lab/results/picture_text.h"
#include "pipeline/image/known_srgb.h"
#include "pipeline/image/metrics.h"

namespace hwsim::lab {
namespace {

using pipeline::Image;

constexpr int kZoom = 4;
constexpr int kGapPx = 8;
constexpr int kLabelPx = kTextHeightPx + kGapPx;

glm::vec4 linear_of_srgb(const glm::vec3& encoded) {
  return {pipeline::linear_from_srgb(encoded.x), pipeline::linear_from_srgb(encoded.y),
          pipeline::linear_from_srgb(encoded.z), 1.0f};
}

size_t index_of(const ShownImage& image, int x, int y) {
  return static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x);
}

glm::vec4 color_at(const ShownImage& image, int x, int y) {
  const std::uint32_t packed = image.srgb8[index_of(image, x, y)];
  const auto channel = [&](int shift) { return static_cast<float>((packed >> shift) & 255u) / 255.0f; };
  return linear_of_srgb({channel(0), channel(8), channel(16)});
}

template <class Function>
void enlarge(Image& sheet, int left, int top, const Region& region, const Function& color) {
  for (int y = 0; y < region.side * kZoom; ++y)
    for (int x = 0; x < region.side * kZoom; ++x)
      sheet.at(left + x, top + y) = color(region.x + x / kZoom, region.y + y / kZoom);
}

/// How much the errors of the images differ at a pixel: their variance; with one image, its error.
double difference_at(std::span<const ShownImage> images, size_t pixel) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (const ShownImage& image : images) {
    if (image.error.empty()) continue;
    const double error = image.error[pixel];
    sum += error;
    squares += error * error;
    count += 1.0;
  }
  return count > 1.0 ? std::max(0.0, squares / count - (sum / count) * (sum / count)) : sum;
}

/// Sums of all rectangles from the corner: the difference within any square in four reads.
std::vector<double> summed_area(std::span<const ShownImage> images, int width, int height) {
  const auto stride = static_cast<size_t>(width) + 1;
  std::vector<double> sums(stride * (static_cast<size_t>(height) + 1), 0.0);
  for (size_t y = 0; y < static_cast<size_t>(height); ++y) {
    double row = 0.0;
    for (size_t x = 0; x < static_cast<size_t>(width); ++x) {
      row += difference_at(images, y * static_cast<size_t>(width) + x);
      sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + row;
    }
  }
  return sums;
}

}  // namespace

ShownImage shown_image(std::string label, const Image& color, const Image* error) {
  ShownImage shown{std::move(label), color.width, color.height, {}, {}};
  pipeline::KnownSrgb encoded;
  shown.srgb8.reserve(color.pixels.size());
  for (const glm::vec4& pixel : color.pixels) {
    std::uint32_t packed = 0;
    for (glm::length_t c = 0; c < 3; ++c)
      packed |= static_cast<std::uint32_t>(std::lround(255.0f * std::clamp(encoded(pixel[c]), 0.0f, 1.0f)))
                << (8 * c);
    shown.srgb8.push_back(packed);
  }
  if (error)
    for (const glm::vec4& pixel : error->pixels) shown.error.push_back(pixel.x);
  return shown;
}

std::vector<Region> worst_regions(std::span<const ShownImage> images, int side, int count) {
  std::vector<Region> regions;
  if (images.empty()) return regions;
  const int width = images.front().width, height = images.front().height;
  side = std::min({side, width, height});
  const std::vector<double> sums = summed_area(images, width, height);
  const auto stride = static_cast<size_t>(width) + 1;
  const auto sum_at = [&](int x, int y) {
    return sums[static_cast<size_t>(y) * stride + static_cast<size_t>(x)];
  };
  const auto overlaps = [&](int x, int y) {
    return std::any_of(regions.begin(), regions.end(),
                       [&](const Region& r) { return std::abs(r.x - x) < side && std::abs(r.y - y) < side; });
  };
  while (static_cast<int>(regions.size()) < count) {
    double worst = -1.0;
    Region best{0, 0, side};
    for (int y = 0; y + side <= height; ++y)
      for (int x = 0; x + side <= width; ++x) {
        const double error =
            sum_at(x + side, y + side) - sum_at(x, y + side) - sum_at(x + side, y) + sum_at(x, y);
        if (error > worst && !overlaps(x, y)) {
          worst = error;
          best = {x, y, side};
        }
      }
    if (worst < 0.0) break;
    regions.push_back(best);
  }
  return regions;
}

Image contact_sheet(std::span<const ShownImage> images, std::span<const Region> regions) {
  const int side = regions.empty() ? 0 : regions.front().side * kZoom;
  const int columns = 2 * static_cast<int>(regions.size());
  const int row_px = kLabelPx + side + kGapPx;
  Image sheet(kGapPx + columns * (side + kGapPx), kGapPx + static_cast<int>(images.size()) * row_px, kPaper);
  int top = kGapPx;
  for (const ShownImage& image : images) {
    draw_text(sheet, kGapPx, top, image.label);
    int left = kGapPx;
    for (const Region& region : regions) {
      enlarge(sheet, left, top + kLabelPx, region, [&](int x, int y) { return color_at(image, x, y); });
      left += side + kGapPx;
    }
    for (const Region& region : regions) {
      if (image.error.empty()) break;
      enlarge(sheet, left, top + kLabelPx, region, [&](int x, int y) {
        return linear_of_srgb(pipeline::magma(image.error[index_of(image, x, y)]));
      });
      left += side + kGapPx;
    }
    top += row_px;
  }
  return sheet;
}

}  // namespace hwsim::lab
