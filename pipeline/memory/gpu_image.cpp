#include "pipeline/memory/gpu_image.h"

#include <algorithm>

#include "pipeline/base/huge_pages.h"
#include "pipeline/base/parallel.h"
#include "pipeline/image/image.h"
#include "pipeline/memory/coverage_map.h"
#include "pipeline/memory/packed_samples.h"
#include "pipeline/simd/codec-inl.h"
#include "pipeline/simd/scalar_lane-inl.h"

namespace hwsim::pipeline {
using namespace HWY_NAMESPACE;  // the scalar lane of the static target

GpuImage::GpuImage(Format f, int w, int h, int s, int array_layers, int coverage)
    : format(f), width(w), height(h), samples(s), layers(array_layers), coverage_samples(coverage) {
  const FormatInfo& format_info = info(f);
  words = format_info.is_depth ? 1 : (format_info.bytes + 3) / 4;
  if (format_info.is_integer) words = format_info.channels;
  blocks_x = (w + kBlockPx - 1) / kBlockPx;
  blocks_y = (h + kBlockPx - 1) / kBlockPx;
  const std::size_t blocks = static_cast<std::size_t>(blocks_x) * static_cast<std::size_t>(blocks_y) *
                             static_cast<std::size_t>(layers);
  place_texels();
  touched_chunk.resize(blocks);
  cleared.resize(blocks);
  if (format_info.is_depth) {
    depth_min.resize(blocks);
    depth_max.resize(blocks);
    plane_count.resize(blocks);
    planes.resize(blocks * kMaxDepthPlanes);
    plane_lanes.resize(blocks * static_cast<std::size_t>(kMaxDepthPlanes * s));
    prefer_huge_pages(planes.data(), planes.size());
    stored_form.resize(blocks, DepthTileForm::raw);
  } else if (samples > 1) {
    single_lanes.resize(blocks);
    double_lanes.resize(blocks);
    second_color.resize(blocks * static_cast<std::size_t>(s));
    stale_lanes.resize(blocks);
  }
  if (coverage_samples > 0) {
    coverage_map.resize(blocks * kBlockLanes * coverage_words(coverage_samples));
    coverage_whole.resize(blocks, ~std::uint64_t{0});
  }
  unsaved.resize(blocks);
  if (format_info.has_stencil) stencil.resize(blocks * static_cast<std::size_t>(s * kBlockLanes));
}

void GpuImage::place_texels() {
  const std::size_t blocks = static_cast<std::size_t>(blocks_x) * static_cast<std::size_t>(blocks_y) *
                             static_cast<std::size_t>(layers);
  texels.resize(blocks * block_words());
  first_samples_apart = samples > 1 && layers == 1 && !info(format).is_depth;
  first_stride = first_samples_apart ? sample_words() : block_words();
  further_begin = first_samples_apart ? blocks * sample_words() : sample_words();
  further_stride = first_samples_apart ? block_words() - sample_words() : block_words();
  // Depth is held as planes, further samples are few: their pages are touched here and there.
  if (!info(format).is_depth && (samples == 1 || first_samples_apart))
    prefer_huge_pages(texels.data(), first_samples_apart ? further_begin : texels.size());
}

void GpuImage::fill(int block_index) {
  cleared[static_cast<std::size_t>(block_index)] = 0;
  for (int sample = 0; sample < samples; ++sample)
    for (int word = 0; word < words; ++word)
      std::fill_n(sample_of_block(block_index, sample) + word * kBlockLanes, kBlockLanes,
                  clear_words[static_cast<std::size_t>(word)]);
  if (!stencil.empty()) std::fill_n(stencil_block(block_index), samples * kBlockLanes, clear_stencil);
}

void GpuImage::fill_first_sample(int block_index) {
  if (!tracks_colors()) return fill(block_index);
  const auto i = static_cast<std::size_t>(block_index);
  cleared[i] = 0;
  stale_lanes[i] = ~std::uint64_t{0};
  for (int word = 0; word < words; ++word)
    std::fill_n(block(block_index) + word * kBlockLanes, kBlockLanes,
                clear_words[static_cast<std::size_t>(word)]);
}

void GpuImage::forget_colors() {
  std::fill(single_lanes.begin(), single_lanes.end(), 0);
  std::fill(double_lanes.begin(), double_lanes.end(), 0);
}

void GpuImage::start_planes(int block_index) {
  const auto i = static_cast<std::size_t>(block_index);
  cleared[i] = 0;
  if (!stencil.empty()) std::fill_n(stencil_block(block_index), samples * kBlockLanes, clear_stencil);
  DepthPlane& plane = tile_planes(block_index)[0];
  plane = {};
  plane.z.base = clear_depth;
  plane.nearest = plane.farthest = clear_words[0];
  std::fill_n(tile_plane_lanes(block_index), samples, lanes_inside(block_index));
  plane_count[i] = 1;
}

std::uint64_t GpuImage::lanes_inside(int block_index) const {
  const int right = width - block_x(block_index), bottom = height - block_y(block_index);
  if (right >= kBlockPx && bottom >= kBlockPx) return ~std::uint64_t{0};
  std::uint64_t inside = 0;
  for (int lane = 0; lane < kBlockLanes; ++lane)
    if (lane_x(lane) < right && lane_y(lane) < bottom) inside |= std::uint64_t{1} << lane;
  return inside;
}

template <class Body>
void GpuImage::for_each_block(int jobs, const Body& body) {
  parallel_for(static_cast<std::size_t>(blocks_y), jobs, [&](std::size_t row, int) {
    const int row_blocks = blocks_x * layers;
    for (int i = 0; i < row_blocks; ++i) body(static_cast<int>(row) * row_blocks + i);
  });
}

void GpuImage::start_all(int jobs) {
  if (info(format).is_depth) return for_each_block(jobs, [&](int block) { use_planes(block); });
  use_all(jobs);
}

void GpuImage::use_all(int jobs) {
  for_each_block(jobs, [&](int block) { use(block); });
}

void GpuImage::release_planes() {
  if (std::ranges::any_of(plane_count, [](std::uint8_t count) { return count != 0; })) return;
  give_back_pages(planes.data(), planes.size());
  give_back_pages(plane_lanes.data(), plane_lanes.size());
}

void GpuImage::expand_all(int jobs) {
  for_each_block(jobs, [&](int block) {
    if (plane_count[static_cast<std::size_t>(block)] != 0) expand_depth_tile(*this, block);
  });
}

void read_texel(const GpuImage& image, int x, int y, int sample, float rgba[4]) {
  ScalarI words[4] = {0, 0, 0, 0};
  for (int word = 0; word < image.words; ++word)
    words[word] = static_cast<std::int32_t>(held_word(image, x, y, sample, word));
  const Vec4<ScalarF> c = decode_texel<ScalarF, ScalarI>(image.format, words, srgb_decode_table().data());
  rgba[0] = c.x.v;
  rgba[1] = c.y.v;
  rgba[2] = c.z.v;
  rgba[3] = c.w.v;
}

}  // namespace hwsim::pipeline
