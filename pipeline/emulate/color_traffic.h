#pragma once
// Multisampled color tiles between the color unit and memory, counted by the colors that their pixels hold:
// what constant-region and fragment-mask compression depend on (docs/compression.md#color).
#include <array>
#include <span>

#include "hwsim/trace/counters.h"
#include "pipeline/memory/gpu_image.h"

namespace hwsim::pipeline {

using PixelCounter = std::uint64_t CropCounters::*;
/// Pixels with one, two, more colors; groups of 8 and of 16 neighboring pixels that all have one.
using PixelCounters = std::array<PixelCounter, 5>;
inline constexpr PixelCounters kReadPixels = {
    &CropCounters::read_single_pixels, &CropCounters::read_double_pixels, &CropCounters::read_mixed_pixels,
    &CropCounters::read_single_groups_8px, &CropCounters::read_single_groups_16px};
inline constexpr PixelCounters kWritePixels = {
    &CropCounters::write_single_pixels, &CropCounters::write_double_pixels, &CropCounters::write_mixed_pixels,
    &CropCounters::write_single_groups_8px, &CropCounters::write_single_groups_16px};

/// Groups of 8 lanes (4x2 pixels) or 16 (4x4) that are all set.
template <int kLanes>
std::uint64_t full_groups(std::uint64_t lanes) {
  for (int step = 1; step < kLanes; step *= 2) lanes &= lanes >> step;
  constexpr std::uint64_t kFirst = kLanes == 8 ? 0x0101010101010101ull : 0x0001000100010001ull;
  return static_cast<std::uint64_t>(__builtin_popcountll(lanes & kFirst));
}

inline void count_pixel_colors(const PixelCounters& counters, const GpuImage& image, int block,
                               CropCounters& n) {
  const auto i = static_cast<std::size_t>(block);
  const std::uint64_t inside = image.lanes_inside(block);
  const std::uint64_t single = image.single_lanes[i] & inside, twice = image.double_lanes[i] & inside;
  const auto count = [](std::uint64_t lanes) {
    return static_cast<std::uint64_t>(__builtin_popcountll(lanes));
  };
  n.*counters[0] += count(single);
  n.*counters[1] += count(twice);
  n.*counters[2] += count(inside & ~(single | twice));
  n.*counters[3] += full_groups<8>(single);
  n.*counters[4] += full_groups<16>(single);
}

/// Gives a written tile back to memory, at the cost of the chunk that used it last.
inline void save_color_tile(GpuImage& image, int block, std::span<PassCounters> chunks) {
  const auto i = static_cast<std::size_t>(block);
  if (image.unsaved[i] == 0) return;
  image.unsaved[i] = 0;
  if (image.tracks_colors())
    count_pixel_colors(kWritePixels, image, block, chunks[image.touched_chunk[i] - 1].crop);
}

}  // namespace hwsim::pipeline
