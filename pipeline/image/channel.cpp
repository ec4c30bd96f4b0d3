#include "pipeline/image/channel.h"

#include <algorithm>
#include <cmath>

#include "pipeline/image/rows.h"

namespace hwsim::pipeline {
namespace {

// out += tap * in, the loop that the compiler turns into vectors.
void accumulate(float* out, const float* in, float tap, int count) {
  for (int x = 0; x < count; ++x) out[x] += tap * in[x];
}

}  // namespace

Channel filter_rows(const Channel& in, std::span<const float> taps, int jobs) {
  Channel out(in.width, in.height);
  const int radius = static_cast<int>(taps.size()) / 2;
  for_rows(in.height, jobs, [&](int y) {
    std::vector<float> padded(static_cast<std::size_t>(in.width + 2 * radius));
    const float* row = in.row(y);
    std::fill_n(padded.begin(), radius, row[0]);
    std::copy_n(row, in.width, padded.begin() + radius);
    std::fill_n(padded.begin() + radius + in.width, radius, row[in.width - 1]);
    for (std::size_t k = 0; k < taps.size(); ++k)
      accumulate(out.row(y), padded.data() + k, taps[k], in.width);
  });
  return out;
}

Channel filter_columns(const Channel& in, std::span<const float> taps, int jobs) {
  Channel out(in.width, in.height);
  const int radius = static_cast<int>(taps.size()) / 2;
  for_rows(in.height, jobs, [&](int y) {
    for (int k = 0; k < static_cast<int>(taps.size()); ++k) {
      const int from = std::clamp(y + k - radius, 0, in.height - 1);
      accumulate(out.row(y), in.row(from), taps[static_cast<std::size_t>(k)], in.width);
    }
  });
  return out;
}

std::vector<float> gaussian_taps(double sigma_px, int radius_px) {
  std::vector<float> taps;
  double sum = 0.0;
  for (int x = -radius_px; x <= radius_px; ++x) sum += std::exp(-x * x / (2.0 * sigma_px * sigma_px));
  for (int x = -radius_px; x <= radius_px; ++x)
    taps.push_back(static_cast<float>(std::exp(-x * x / (2.0 * sigma_px * sigma_px)) / sum));
  return taps;
}

}  // namespace hwsim::pipeline
