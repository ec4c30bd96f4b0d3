#include "pipeline/emulate/transfer.h"

#include <algorithm>
#include <cstring>

#include "pipeline/base/parallel.h"
#include "pipeline/depth/depth_format.h"
#include "pipeline/shade/texture_view.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pipeline/emulate/transfer.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "pipeline/shade/codec-inl.h"
#include "pipeline/shade/lanes-inl.h"
#include "pipeline/shade/scalar_lane-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hwsim::pipeline::HWY_NAMESPACE {

void resolve_block(const GpuImage& from, GpuImage& to, int block) {
  const auto* source = reinterpret_cast<const std::int32_t*>(from.block(block));
  auto* target = reinterpret_cast<std::int32_t*>(to.block(block));
  const float* srgb = srgb_decode_table().data();
  const LaneF weight(1.0f / static_cast<float>(from.samples));
  for (int first = 0; first < kBlockLanes; first += kVectorLanes) {
    Vec4<LaneF> sum = {LaneF(0.0f), LaneF(0.0f), LaneF(0.0f), LaneF(0.0f)};
    for (int s = 0; s < from.samples; ++s) {
      LaneI words[4] = {LaneI(0), LaneI(0), LaneI(0), LaneI(0)};
      for (int w = 0; w < from.words; ++w)
        words[w] = load(source + (s * from.words + w) * kBlockLanes + first);
      sum = sum + decode_texel<LaneF, LaneI>(from.format, words, srgb);
    }
    LaneI encoded[4];
    encode_texel<LaneF, LaneI>(to.format, sum * weight, encoded);
    for (int w = 0; w < to.words; ++w) store(encoded[w], target + w * kBlockLanes + first);
  }
}

/// The largest depth of each pixel's samples: codes order as depths do.
void resolve_depth_block(const GpuImage& from, GpuImage& to, int block) {
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
void decode_block(const GpuImage& from, int block, float (&rgba)[4][kBlockLanes]) {
  const auto* source = reinterpret_cast<const std::int32_t*>(from.block(block));
  for (int first = 0; first < kBlockLanes; first += kVectorLanes) {
    LaneI words[4] = {LaneI(0), LaneI(0), LaneI(0), LaneI(0)};
    for (int w = 0; w < from.words; ++w) words[w] = load(source + w * kBlockLanes + first);
    const Vec4<LaneF> c = decode_texel<LaneF, LaneI>(from.format, words, srgb_decode_table().data());
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

Image to_linear_image(const GpuImage& from, int jobs) {
  Image out(from.width, from.height);
  const auto decode = HWY_DYNAMIC_DISPATCH(decode_block);
  parallel_for(static_cast<std::size_t>(from.blocks_y), jobs, [&](std::size_t row, int) {
    float rgba[4][kBlockLanes];
    for (int bx = 0; bx < from.blocks_x; ++bx) {
      decode(from, static_cast<int>(row) * from.blocks_x + bx, rgba);
      for (int lane = 0; lane < kBlockLanes; ++lane) {
        const int x = bx * kBlockPx + lane_x(lane), y = static_cast<int>(row) * kBlockPx + lane_y(lane);
        if (x < out.width && y < out.height)
          out.at(x, y) = {rgba[0][lane], rgba[1][lane], rgba[2][lane], rgba[3][lane]};
      }
    }
  });
  return out;
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
  std::fill(to.cleared.begin(), to.cleared.end(), 0);
}

void resolve_image(const GpuImage& from, GpuImage& to, int jobs) {
  const auto resolve = info(from.format).is_depth ? HWY_DYNAMIC_DISPATCH(resolve_depth_block)
                                                  : HWY_DYNAMIC_DISPATCH(resolve_block);
  parallel_for(static_cast<std::size_t>(to.blocks_y), jobs, [&](std::size_t row, int) {
    for (int bx = 0; bx < to.blocks_x; ++bx) {
      const int block = static_cast<int>(row) * to.blocks_x + bx;
      to.cleared[static_cast<std::size_t>(block)] = 0;
      resolve(from, to, block);
    }
  });
}

std::vector<PassCounters> count_transfer(const Pass& pass, const GpuImage* source,
                                         std::span<GpuImage* const> targets) {
  constexpr std::uint64_t kBands = 64;
  std::vector<PassCounters> chunks(kBands);
  const auto band = [&](std::uint64_t amount, std::uint64_t i) {
    return amount * (i + 1) / kBands - amount * i / kBands;
  };
  for (std::uint64_t i = 0; i < kBands; ++i) {
    PassCounters& n = chunks[i];
    for (const GpuImage* target : targets) {
      const auto tiles =
          static_cast<std::uint64_t>(target->blocks_x) * static_cast<std::uint64_t>(target->blocks_y);
      const auto pixels =
          static_cast<std::uint64_t>(target->width) * static_cast<std::uint64_t>(target->height);
      const std::uint64_t bytes = info(target->format).bytes;
      const auto samples = static_cast<std::uint64_t>(target->samples);
      if (pass.kind == PassKind::clear) {
        n.fe.cleared_tiles += band(tiles, i) * samples;
        continue;
      }
      const std::uint64_t read = pixels * static_cast<std::uint64_t>(source->samples);
      const bool depth = info(source->format).is_depth;
      (depth ? n.mem.depth_read_bytes : n.mem.color_read_bytes) += band(read * info(source->format).bytes, i);
      (depth ? n.mem.depth_write_bytes : n.mem.color_write_bytes) += band(pixels * samples * bytes, i);
      n.resolve.read_samples += band(read, i);
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
