#include "pipeline/emulate/shading_heat.h"

#include <algorithm>
#include <functional>

#include "pipeline/base/parallel.h"

namespace hwsim::pipeline {

ShadingHeat::ShadingHeat(int width, int height)
    : width_(width), height_(height), blocks_x_((width + kBlockPx - 1) / kBlockPx) {
  const int blocks_y = (height + kBlockPx - 1) / kBlockPx;
  counts_.resize(static_cast<std::size_t>(blocks_x_ * blocks_y) * kBlockLanes);
}

void ShadingHeat::attach(PassContext& context) {
  for (int shift = 0; shift < 5; ++shift) {
    if (context.width != width_ << shift || context.height != height_ << shift) continue;
    context.heat = counts_.data();
    context.heat_blocks_x = blocks_x_;
    context.heat_shift = shift;
  }
}

Image ShadingHeat::image(int jobs) const {
  Image out(width_, height_);
  parallel_for(static_cast<std::size_t>((height_ + kBlockPx - 1) / kBlockPx), jobs,
               [&](std::size_t row, int) {
                 const int first = static_cast<int>(row) * kBlockPx;
                 for (int y = first; y < std::min(first + kBlockPx, height_); ++y)
                   for (int x = 0; x < width_; ++x)
                     out.at(x, y).x = static_cast<float>(counts_[static_cast<std::size_t>(
                         ((y >> 3) * blocks_x_ + (x >> 3)) * kBlockLanes + lane_of(x & 7, y & 7))]);
               });
  return out;
}

void ShadingHeat::add(std::span<const std::uint32_t> counts) {
  for (std::size_t i = 0; i < counts.size(); ++i) counts_[i] += counts[i];
}

std::vector<std::uint32_t> ShadingHeat::added_since(std::span<const std::uint32_t> before) const {
  std::vector<std::uint32_t> added(counts_.size());
  std::transform(counts_.begin(), counts_.end(), before.begin(), added.begin(), std::minus<>());
  if (std::ranges::all_of(added, [](std::uint32_t n) { return n == 0; })) added.clear();
  return added;
}

}  // namespace hwsim::pipeline
