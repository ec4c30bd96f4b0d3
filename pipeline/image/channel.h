#pragma once
// One channel of an image, and separable filters on it.
#include <cstddef>
#include <span>
#include <vector>

namespace hwsim::pipeline {

struct Channel {
  int width = 0;
  int height = 0;
  std::vector<float> values;

  Channel(int w, int h)
      : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  float* row(int y) { return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width); }
  const float* row(int y) const {
    return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
};

/// Correlation with an odd number of taps along rows or columns; the border's values are repeated outside.
Channel filter_rows(const Channel& in, std::span<const float> taps, int jobs = 1);
Channel filter_columns(const Channel& in, std::span<const float> taps, int jobs = 1);

/// 2 radius + 1 taps exp(-x^2 / (2 sigma_px^2)) that sum to 1.
std::vector<float> gaussian_taps(double sigma_px, int radius_px);

}  // namespace hwsim::pipeline
