// Multisampled color while shaders read it: one texel for each pixel of one color, all samples of the others.
#include "pipeline/memory/packed_samples.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

#include "pipeline/base/parallel.h"

namespace hwsim::pipeline {
namespace {
constexpr int kQuadLanes = 4, kTileQuads = kBlockLanes / kQuadLanes;

std::uint32_t lanes_of_quad(std::uint64_t lanes, int quad) {
  return static_cast<std::uint32_t>(lanes >> (kQuadLanes * quad)) & 15u;
}

/// Quads of a tile that hold more than one color somewhere, as bits.
std::uint32_t mixed_quads(const GpuImage& image, int block) {
  const std::uint64_t mixed =
      image.lanes_inside(block) & ~image.single_lanes[static_cast<std::size_t>(block)];
  std::uint32_t quads = 0;
  for (int quad = 0; mixed != 0 && quad < kTileQuads; ++quad)
    if (lanes_of_quad(mixed, quad) != 0) quads |= 1u << quad;
  return quads;
}

/// The further samples of a quad; those of stale lanes are sample 0's.
void pack_quad(const GpuImage& image, int block, int quad, std::uint32_t* to) {
  const std::uint32_t stale = lanes_of_quad(image.stale_lanes[static_cast<std::size_t>(block)], quad);
  for (int sample = 1; sample < image.samples; ++sample)
    for (int word = 0; word < image.words; ++word, to += kQuadLanes) {
      const int place = word * kBlockLanes + quad * kQuadLanes;
      std::memcpy(to, image.sample_of_block(block, sample) + place, kQuadLanes * sizeof(*to));
      for (std::uint32_t rest = stale; rest != 0; rest &= rest - 1) {
        const int lane = std::countr_zero(rest);
        to[lane] = image.block(block)[place + lane];
      }
    }
}

void unpack_quad(GpuImage& image, int block, int quad, const std::uint32_t* from) {
  for (int sample = 1; sample < image.samples; ++sample)
    for (int word = 0; word < image.words; ++word, from += kQuadLanes)
      std::memcpy(image.sample_of_block(block, sample) + word * kBlockLanes + quad * kQuadLanes, from,
                  kQuadLanes * sizeof(*from));
}

}  // namespace

std::uint32_t held_word(const GpuImage& image, int x, int y, int sample, int word) {
  if (image.packed.quad_start.empty() || sample == 0)
    return image.texels[image.word_index(x, y, sample, word)];
  const int lane = lane_of(x & 7, y & 7), quad = (image.block_index(x, y) * kBlockLanes + lane) / kQuadLanes;
  const std::int32_t start = image.packed.quad_start[static_cast<std::size_t>(quad)];
  if (start == PackedSamples::kOneColor) return image.texels[image.word_index(x, y, 0, word)];
  const int place = ((sample - 1) * image.words + word) * kQuadLanes + lane % kQuadLanes;
  return image.packed.words[static_cast<std::size_t>(start + place)];
}

void GpuImage::release_further_samples(int row) {
  const std::size_t begin = further_begin + static_cast<std::size_t>(row * blocks_x) * further_stride;
  give_back_pages(texels.data() + begin, static_cast<std::size_t>(blocks_x) * further_stride);
}

void GpuImage::begin_reads(bool pack, int jobs) {
  if (!packed.quad_start.empty()) return;
  if (!pack || !first_samples_apart) return use_all(jobs);
  std::vector<std::size_t> row_quads(static_cast<std::size_t>(blocks_y) + 1, 0);
  parallel_for(static_cast<std::size_t>(blocks_y), jobs, [&](std::size_t row, int) {
    for (int bx = 0; bx < blocks_x; ++bx) {
      const int block = static_cast<int>(row) * blocks_x + bx;
      use_first_sample(block);
      row_quads[row + 1] += static_cast<std::size_t>(std::popcount(mixed_quads(*this, block)));
    }
  });
  std::partial_sum(row_quads.begin(), row_quads.end(), row_quads.begin());
  if (row_quads.back() * 2 > cleared.size() * kTileQuads) return use_all(jobs);
  const std::size_t quad_words =
      static_cast<std::size_t>(samples - 1) * static_cast<std::size_t>(words) * kQuadLanes;
  packed.words.resize(row_quads.back() * quad_words);
  packed.quad_start.assign(cleared.size() * kTileQuads, PackedSamples::kOneColor);
  parallel_for(static_cast<std::size_t>(blocks_y), jobs, [&](std::size_t row, int) {
    std::size_t next = row_quads[row] * quad_words;
    for (int bx = 0; bx < blocks_x; ++bx) {
      const int block = static_cast<int>(row) * blocks_x + bx;
      for (std::uint32_t rest = mixed_quads(*this, block); rest != 0; rest &= rest - 1) {
        const int quad = std::countr_zero(rest);
        packed.quad_start[static_cast<std::size_t>(block * kTileQuads + quad)] =
            static_cast<std::int32_t>(next);
        pack_quad(*this, block, quad, packed.words.data() + next);
        next += quad_words;
      }
      stale_lanes[static_cast<std::size_t>(block)] |= single_lanes[static_cast<std::size_t>(block)];
    }
    release_further_samples(static_cast<int>(row));
  });
}

void GpuImage::end_reads(int jobs) {
  if (packed.quad_start.empty()) return;
  const int row_quads = blocks_x * kTileQuads;
  parallel_for(static_cast<std::size_t>(blocks_y), jobs, [&](std::size_t row, int) {
    for (int i = static_cast<int>(row) * row_quads; i < static_cast<int>(row + 1) * row_quads; ++i) {
      const std::int32_t start = packed.quad_start[static_cast<std::size_t>(i)];
      if (start != PackedSamples::kOneColor)
        unpack_quad(*this, i / kTileQuads, i % kTileQuads, packed.words.data() + start);
    }
  });
  packed = {};
}

}  // namespace hwsim::pipeline
