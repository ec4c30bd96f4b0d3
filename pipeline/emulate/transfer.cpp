#include "pipeline/emulate/transfer.h"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "pipeline/base/parallel.h"
#include "pipeline/emulate/color_traffic.h"
#include "pipeline/graph/frame_graph.h"
#include "pipeline/memory/coverage_map.h"
#include "pipeline/memory/depth_format.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pipeline/emulate/transfer.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/emulate/color_write-inl.h"
#include "pipeline/simd/codec-inl.h"
#include "pipeline/simd/lanes-inl.h"
#include "pipeline/simd/scalar_lane-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

/// The sum over the samples of one register of pixels, in pairs: a power of two of equal values sums without
/// rounding, so that pixels of one color give that color whether their samples are read or not.
HWY_INLINE Vec4<LaneF> sum_samples(const GpuImage& from, int block, int first) {
  Vec4<LaneF> partial[6] = {};
  const float* srgb = srgb_decode_table().data();
  int level = 0;
  for (int s = 0; s < from.samples; ++s) {
    const auto* at_sample = reinterpret_cast<const std::int32_t*>(from.sample_of_block(block, s));
    LaneI words[4] = {LaneI(0), LaneI(0), LaneI(0), LaneI(0)};
    for (int w = 0; w < from.words; ++w) words[w] = load(at_sample + w * kBlockLanes + first);
    Vec4<LaneF> sum = decode_texel<LaneF, LaneI>(from.format, words, srgb);
    for (level = 0; (s >> level & 1) != 0; ++level) sum = partial[level] + sum;
    partial[level] = sum;
  }
  return partial[level];
}

/// Each color with the positions that name its sample (memory/coverage_map.h).
HWY_INLINE Vec4<LaneF> mean_of_positions(const GpuImage& from, int block, int first) {
  HWY_ALIGN float weight[kMaxSamples][kVectorLanes] = {};
  const CoverageLayout& layout = coverage_layout(from.samples, from.coverage_samples);
  const std::size_t words_of_map = coverage_words(from.coverage_samples);
  const std::uint64_t whole = from.coverage_whole[static_cast<std::size_t>(block)];
  for (int i = 0; i < kVectorLanes; ++i) {
    const auto lane = static_cast<std::size_t>(first + i);
    const std::uint64_t* stored =
        from.coverage_map.data() + (static_cast<std::size_t>(block) * kBlockLanes + lane) * words_of_map;
    const CoverageWord map = (whole >> lane & 1) != 0 ? CoverageWord() : CoverageWord(stored, words_of_map);
    for (int q = 0; q < from.coverage_samples; ++q) {
      const std::uint32_t sample = q < from.samples ? static_cast<std::uint32_t>(q) : layout.shown_at(map, q);
      weight[sample][i] += 1.0f;
    }
  }
  Vec4<LaneF> sum{LaneF(0.0f), LaneF(0.0f), LaneF(0.0f), LaneF(0.0f)};
  for (int s = 0; s < from.samples; ++s) {
    const auto* at_sample = reinterpret_cast<const std::int32_t*>(from.sample_of_block(block, s));
    LaneI words[4] = {LaneI(0), LaneI(0), LaneI(0), LaneI(0)};
    for (int w = 0; w < from.words; ++w) words[w] = load(at_sample + w * kBlockLanes + first);
    const Vec4<LaneF> c = decode_texel<LaneF, LaneI>(from.format, words, srgb_decode_table().data());
    sum = sum + c * load(weight[s]);
  }
  return sum * LaneF(1.0f / static_cast<float>(from.coverage_samples));
}

void resolve_block(const GpuImage& from, GpuImage& to, int block, std::uint64_t single) {
  const auto* source = reinterpret_cast<const std::int32_t*>(from.block(block));
  auto* target = reinterpret_cast<std::int32_t*>(to.block(block));
  const float* srgb = srgb_decode_table().data();
  const LaneF weight(1.0f / static_cast<float>(from.samples));
  for (int first = 0; first < kBlockLanes; first += kVectorLanes) {
    Vec4<LaneF> mean{LaneF(0.0f), LaneF(0.0f), LaneF(0.0f), LaneF(0.0f)};
    if ((~single >> first & kRegisterBits) == 0) {
      LaneI words[4] = {LaneI(0), LaneI(0), LaneI(0), LaneI(0)};
      for (int w = 0; w < from.words; ++w) words[w] = load(source + w * kBlockLanes + first);
      mean = decode_texel<LaneF, LaneI>(from.format, words, srgb);
    } else if (from.coverage_samples > 0) {
      mean = mean_of_positions(from, block, first);
    } else {
      mean = sum_samples(from, block, first) * weight;
    }
    LaneI encoded[4];
    encode_texel<LaneF, LaneI>(to.format, mean, encoded);
    for (int w = 0; w < to.words; ++w) store(encoded[w], target + w * kBlockLanes + first);
  }
}

/// The largest depth of each pixel's samples: codes order as depths do.
void resolve_depth_block(const GpuImage& from, GpuImage& to, int block, std::uint64_t /*single*/) {
  const auto* source = reinterpret_cast<const std::int32_t*>(from.block(block));
  auto* target = reinterpret_cast<std::int32_t*>(to.block(block));
  std::uint32_t low = 0xffffffffu, high = 0;
  for (int first = 0; first < kBlockLanes; first += kVectorLanes) {
    LaneI most = load(source + first);
    for (int s = 1; s < from.samples; ++s) most = max(most, load(source + s * kBlockLanes + first));
    store(most, target + first);
  }
  for (int lane = 0; lane < kBlockLanes; ++lane) {
    low = std::min(low, static_cast<std::uint32_t>(target[lane]));
    high = std::max(high, static_cast<std::uint32_t>(target[lane]));
  }
  to.plane_count[static_cast<std::size_t>(block)] = 0;
  to.depth_min[static_cast<std::size_t>(block)] = low;
  to.depth_max[static_cast<std::size_t>(block)] = high;
}

/// Sample 0 of a tile, decoded: rgba[channel][lane].
void decode_block(const GpuImage& from, Format format, int block, float (&rgba)[4][kBlockLanes]) {
  const auto* source = reinterpret_cast<const std::int32_t*>(from.block(block));
  for (int first = 0; first < kBlockLanes; first += kVectorLanes) {
    LaneI words[4] = {LaneI(0), LaneI(0), LaneI(0), LaneI(0)};
    for (int w = 0; w < from.words; ++w) words[w] = load(source + w * kBlockLanes + first);
    const Vec4<LaneF> c = decode_texel<LaneF, LaneI>(format, words, srgb_decode_table().data());
    store(c.x, rgba[0] + first);
    store(c.y, rgba[1] + first);
    store(c.z, rgba[2] + first);
    store(c.w, rgba[3] + first);
  }
}

}  // namespace hwsim::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hwsim::pipeline {
HWY_EXPORT(resolve_block);
HWY_EXPORT(resolve_depth_block);
HWY_EXPORT(decode_block);

Image to_linear_image(const GpuImage& from, Format format, int jobs) {
  Image out(from.width, from.height);
  const auto decode = HWY_DYNAMIC_DISPATCH(decode_block);
  parallel_for(static_cast<std::size_t>(from.blocks_y), jobs, [&](std::size_t row, int) {
    float rgba[4][kBlockLanes];
    for (int bx = 0; bx < from.blocks_x; ++bx) {
      decode(from, format, static_cast<int>(row) * from.blocks_x + bx, rgba);
      for (int lane = 0; lane < kBlockLanes; ++lane) {
        const int x = bx * kBlockPx + lane_x(lane), y = static_cast<int>(row) * kBlockPx + lane_y(lane);
        if (x < out.width && y < out.height)
          out.at(x, y) = {rgba[0][lane], rgba[1][lane], rgba[2][lane], rgba[3][lane]};
      }
    }
  });
  return out;
}

void upload_image(const RawImage& contents, GpuImage& image) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      image.texels[image.word_index(x, y, 0, 0)] =
          contents.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                          static_cast<std::size_t>(x)];
}

void clear_image(GpuImage& image, const Pass& pass) {
  image.clear_stencil = pass.clear_stencil;
  std::fill(image.cleared.begin(), image.cleared.end(), 1);
  if (info(image.format).is_depth) {
    const std::uint32_t bits = depth_bits(pass.clear_depth, depth_scale(image.format));
    image.clear_words = {bits, 0, 0, 0};
    image.clear_depth = pass.clear_depth;
    std::fill(image.plane_count.begin(), image.plane_count.end(), 0);
    std::fill(image.stored_form.begin(), image.stored_form.end(), DepthTileForm::clear);
    std::fill(image.depth_min.begin(), image.depth_min.end(), bits);
    std::fill(image.depth_max.begin(), image.depth_max.end(), bits);
    return;
  }
  std::fill(image.coverage_whole.begin(), image.coverage_whole.end(), ~std::uint64_t{0});
  std::fill(image.single_lanes.begin(), image.single_lanes.end(), ~std::uint64_t{0});
  std::fill(image.double_lanes.begin(), image.double_lanes.end(), 0);
  std::fill(image.stale_lanes.begin(), image.stale_lanes.end(), 0);
  const glm::vec4& c = pass.clear_color;
  using HWY_NAMESPACE::ScalarF;
  using HWY_NAMESPACE::ScalarI;
  ScalarI encoded[4] = {0, 0, 0, 0};
  HWY_NAMESPACE::encode_texel<ScalarF, ScalarI>(image.format, {c.x, c.y, c.z, c.w}, encoded);
  for (std::size_t w = 0; w < 4; ++w) image.clear_words[w] = static_cast<std::uint32_t>(encoded[w].v);
}

void copy_image(const GpuImage& from, GpuImage& to) {
  to.texels = from.texels;
  to.stencil = from.stencil;
  to.depth_min = from.depth_min;
  to.depth_max = from.depth_max;
  to.plane_count.assign(from.plane_count.size(), 0);  // read with use_all: its texels are valid
  to.stored_form = from.stored_form;
  to.single_lanes = from.single_lanes;
  to.double_lanes = from.double_lanes;
  to.second_color = from.second_color;
  to.stale_lanes.assign(from.stale_lanes.size(), 0);
  std::fill(to.cleared.begin(), to.cleared.end(), 0);
}

std::uint64_t resolve_image(GpuImage& from, GpuImage& to, bool skip_single_colors, int jobs) {
  const auto resolve = info(from.format).is_depth ? HWY_DYNAMIC_DISPATCH(resolve_depth_block)
                                                  : HWY_DYNAMIC_DISPATCH(resolve_block);
  const bool skip = skip_single_colors && from.tracks_colors();
  if (!skip) from.use_all(jobs);
  std::vector<std::uint64_t> skipped(static_cast<std::size_t>(to.blocks_y));
  parallel_for(static_cast<std::size_t>(to.blocks_y), jobs, [&](std::size_t row, int) {
    for (int bx = 0; bx < to.blocks_x; ++bx) {
      const int block = static_cast<int>(row) * to.blocks_x + bx;
      const auto i = static_cast<std::size_t>(block);
      const std::uint64_t single = skip ? from.single_lanes[i] : 0;
      if (skip) from.use_first_sample(block);
      if (skip && ~single != 0) from.use(block);
      to.cleared[i] = 0;
      resolve(from, to, block, single);
      skipped[row] += static_cast<std::uint64_t>(__builtin_popcountll(single & from.lanes_inside(block)));
    }
  });
  return std::accumulate(skipped.begin(), skipped.end(), std::uint64_t{0});
}

std::vector<PassCounters> count_transfer(const Pass& pass, const GpuImage* source,
                                         std::span<GpuImage* const> targets) {
  constexpr std::uint64_t kBands = 64;
  std::vector<PassCounters> chunks(kBands);
  CropCounters read;
  if (source != nullptr && source->tracks_colors())
    for (int block = 0; block < source->blocks_x * source->blocks_y * source->layers; ++block)
      count_pixel_colors(kReadPixels, *source, block, read);
  const std::uint64_t map_bytes =  // pixels that hold one color need nothing more
      source == nullptr ? 0
                        : coverage_map_bytes(source->samples, source->coverage_samples) *
                              (read.read_double_pixels + read.read_mixed_pixels);
  const auto band = [&](std::uint64_t amount, std::uint64_t i) {
    return amount * (i + 1) / kBands - amount * i / kBands;
  };
  for (std::uint64_t i = 0; i < kBands; ++i) {
    PassCounters& n = chunks[i];
    for (const GpuImage* target : targets) {
      const auto layers = static_cast<std::uint64_t>(target->layers);
      const auto tiles = static_cast<std::uint64_t>(target->blocks_x) *
                         static_cast<std::uint64_t>(target->blocks_y) * layers;
      const auto pixels =
          static_cast<std::uint64_t>(target->width) * static_cast<std::uint64_t>(target->height) * layers;
      const std::uint64_t bytes = info(target->format).bytes;
      const auto samples = static_cast<std::uint64_t>(target->samples);
      if (pass.kind == PassKind::clear) {
        n.fe.cleared_tiles += band(tiles, i) * samples;
        continue;
      }
      const std::uint64_t samples_read = pixels * static_cast<std::uint64_t>(source->samples);
      const bool depth = info(source->format).is_depth;
      (depth ? n.mem.depth_read_bytes : n.mem.color_read_bytes) +=
          band(samples_read * info(source->format).bytes, i);
      (depth ? n.mem.depth_write_bytes : n.mem.color_write_bytes) += band(pixels * samples * bytes, i);
      n.resolve.read_samples += band(samples_read, i);
      n.mem.other_read_bytes += band(map_bytes, i);
      for (const PixelCounter counter : kReadPixels) n.crop.*counter += band(read.*counter, i);
      n.resolve.written_pixels += band(pixels, i);
      if (depth) continue;  // each tile moves once
      n.crop.touched_tiles += band(tiles, i);
      n.crop.first_touched_tiles += band(tiles, i);
    }
  }
  return chunks;
}

}  // namespace hwsim::pipeline
#endif
