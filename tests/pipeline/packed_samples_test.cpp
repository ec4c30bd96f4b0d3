// Multisampled color while shaders read it: packed samples are those of the image, and come back.
#include "pipeline/memory/packed_samples.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>
#include <vector>

// One vector target is enough here: without foreach_target.
#include "pipeline/shade/image_access-inl.h"

namespace hwsim::pipeline {
namespace {
namespace lanes = HWY_NAMESPACE;

constexpr int kWidth = 45, kHeight = 21, kSamples = 4;

using Words = std::vector<std::uint32_t>;

/// Pixels of one color and of several, some of the former written at sample 0 alone; `mixed_share` of all
/// pixels lie in tiles that mix. Returns the true words, pixel by pixel, sample by sample.
Words paint(GpuImage& image, double mixed_share) {
  std::mt19937 random(7);
  const auto chance = [&](double share) { return std::uniform_real_distribution<>()(random) < share; };
  Words truth;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const auto block = static_cast<std::size_t>(image.block_index(x, y));
      const std::uint64_t lane = std::uint64_t{1} << lane_of(x & 7, y & 7);
      const bool mixed = chance(mixed_share), stale = !mixed && chance(0.5);
      if (!mixed) image.single_lanes[block] |= lane;
      if (stale) image.stale_lanes[block] |= lane;
      Words first;
      for (int word = 0; word < image.words; ++word) first.push_back(static_cast<std::uint32_t>(random()));
      for (int sample = 0; sample < kSamples; ++sample)
        for (int word = 0; word < image.words; ++word) {
          const bool own = mixed && sample > 0;
          truth.push_back(own ? static_cast<std::uint32_t>(random()) : first[static_cast<std::size_t>(word)]);
          const bool written = sample == 0 || !stale;
          image.texels[image.word_index(x, y, sample, word)] = written ? truth.back() : 0xdeadbeefu;
        }
    }
  return truth;
}

/// As shaders read, a register of pixels at a time.
Words read_as_shaders(const GpuImage& image) {
  Words words(static_cast<std::size_t>(kWidth * kHeight * kSamples * image.words));
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; x += lanes::kVectorLanes)
      for (int sample = 0; sample < kSamples; ++sample) {
        HWY_ALIGN std::int32_t px[lanes::kVectorLanes], out[lanes::kVectorLanes];
        for (int i = 0; i < lanes::kVectorLanes; ++i) px[i] = x + i;
        const lanes::TexelWords at =
            lanes::texel_words(image, lanes::load(px), lanes::LaneI(y), lanes::LaneI(sample));
        for (int word = 0; word < image.words; ++word) {
          lanes::store(at.load(image, word), out);
          for (int i = 0; i < lanes::kVectorLanes && x + i < kWidth; ++i)
            words[static_cast<std::size_t>(((y * kWidth + x + i) * kSamples + sample) * image.words + word)] =
                static_cast<std::uint32_t>(out[i]);
        }
      }
  return words;
}

Words read_words(const GpuImage& image) {
  Words words;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int sample = 0; sample < kSamples; ++sample)
        for (int word = 0; word < image.words; ++word) words.push_back(held_word(image, x, y, sample, word));
  return words;
}

TEST(PackedSamples, ShadersReadWhatTheImageHolds) {
  for (const Format format : {Format::rgba8_unorm, Format::rgba16_float})
    for (const double mixed_share : {0.0, 0.02, 0.9})
      for (const bool pack : {true, false}) {
        GpuImage image(format, kWidth, kHeight, kSamples);
        const Words truth = paint(image, mixed_share);
        image.begin_reads(pack, 2);
        EXPECT_EQ(!image.packed.quad_start.empty(), pack && mixed_share < 0.5);
        EXPECT_EQ(read_as_shaders(image), truth) << mixed_share << pack;
        EXPECT_EQ(read_words(image), truth) << mixed_share << pack;
        image.begin_reads(pack, 1);  // by a later pass
        EXPECT_EQ(read_as_shaders(image), truth) << mixed_share << pack;
        image.end_reads(2);
        EXPECT_TRUE(image.packed.quad_start.empty());
        image.use_all(1);
        EXPECT_EQ(read_words(image), truth) << mixed_share << pack;
      }
}

TEST(PackedSamples, QuadsOfOneColorTakeNoFurtherSamples) {
  GpuImage image(Format::rgba8_unorm, kWidth, kHeight, kSamples);
  paint(image, 0.02);
  std::size_t mixed = 0;
  for (int y = 0; y < kHeight; y += 2)
    for (int x = 0; x < kWidth; x += 2) {
      bool several = false;
      for (int i = 0; i < 4; ++i) {
        const int px = x + i % 2, py = y + i / 2;
        if (px >= kWidth || py >= kHeight) continue;
        const auto block = static_cast<std::size_t>(image.block_index(px, py));
        several = several || (image.single_lanes[block] >> lane_of(px & 7, py & 7) & 1) == 0;
      }
      mixed += several ? 1 : 0;
    }
  image.begin_reads(true, 1);
  EXPECT_EQ(image.packed.words.size(), mixed * 4 * (kSamples - 1));
}

TEST(PackedSamples, AClearedImageReadsItsClearValue) {
  GpuImage image(Format::rgba8_unorm, kWidth, kHeight, kSamples);
  std::fill(image.cleared.begin(), image.cleared.end(), 1);
  std::fill(image.single_lanes.begin(), image.single_lanes.end(), ~std::uint64_t{0});
  image.clear_words[0] = 0x01020304u;
  image.begin_reads(true, 1);
  const Words words = read_as_shaders(image);
  EXPECT_TRUE(std::all_of(words.begin(), words.end(), [](std::uint32_t w) { return w == 0x01020304u; }));
}

}  // namespace
}  // namespace hwsim::pipeline
