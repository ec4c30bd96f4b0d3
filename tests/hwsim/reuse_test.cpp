// Reuse distances against a list of recently used blocks, and samples against all blocks.
#include "hwsim/trace/reuse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "hwsim/timing/traffic.h"

namespace hwsim {
namespace {

constexpr auto kTexture = ReuseStream::texture;

/// Reads that wander over a picture of lines, as texture reads of neighboring tiles do, with jumps.
std::vector<BlockAccess> wandering_reads(std::uint32_t lines, std::size_t count, unsigned seed) {
  std::mt19937 engine(seed);
  const auto random = [&engine]() { return static_cast<std::uint32_t>(engine()); };
  std::vector<BlockAccess> reads;
  std::uint32_t place = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned kind = random() % 64;
    if (kind == 0)
      place = random() % lines;
    else
      place = (place + random() % 24) % lines;
    const std::uint32_t line = kind < 24 ? (place + lines - random() % std::min(lines, 600u)) % lines : place;
    reads.push_back({i, line, kTexture, 4, 0});
  }
  return reads;
}

std::vector<BlockAccess> sample_of(const std::vector<BlockAccess>& accesses, int shift) {
  std::vector<BlockAccess> part;
  for (const BlockAccess& a : accesses)
    if (is_sampled(a.block, shift)) part.push_back(a);
  return part;
}

ReuseProfile analyze(const std::vector<BlockAccess>& accesses, BlockKinds kinds = {}) {
  return analyze_reuse(accesses, kinds, SIZE_MAX);
}

/// Bytes read by a fully associative cache, by its definition.
std::uint64_t lru_bytes(const std::vector<BlockAccess>& accesses, std::size_t cache_bytes) {
  SetAssociativeCache cache(cache_bytes, 64, cache_bytes / 64);
  std::uint64_t bytes = 0;
  for (const BlockAccess& a : accesses) bytes += cache.access(a.block) ? 0 : 64;
  return bytes;
}

TEST(Reuse, CurveOfAllBlocksEqualsTheCacheOfEverySize) {
  const std::vector<BlockAccess> reads = wandering_reads(3000, 20'000, 1);
  const MissCurve curve = analyze(reads).apart[index_of(kTexture)];
  for (std::size_t k = 0; k < 8; ++k)
    EXPECT_EQ(curve.read_bytes[k], lru_bytes(reads, std::size_t{1024} << k)) << k;
}

TEST(Reuse, TilesComeWholeOrInPartAndLeaveWithWhatWasWritten) {
  BlockKinds kinds;
  kinds[index_of(ReuseStream::color)] = {512, false, 0};
  // Tiles 1 2 1 3 1; a cache of 1 KiB holds two.
  const auto c = ReuseStream::color;
  const std::vector<BlockAccess> accesses = {{0, 1, c, 0, 100}, {1, 2, c, 0, 600}, {2, 1, c, 16, 100},
                                             {3, 3, c, 0, 10},  {4, 1, c, 0, 400}, {5, 2, c, 0, 8}};
  const MissCurve curve = analyze(accesses, kinds).apart[index_of(c)];
  EXPECT_EQ(curve.requested_write_bytes, 1218u);
  EXPECT_EQ(curve.write_bytes[0], 512u + 512u + 10u + 8u);  // tile 1 capped; tile 2 capped, then again 8
  EXPECT_EQ(curve.write_bytes[1], 512u + 512u + 10u);       // 2 KiB hold all: tile 2 stays capped
  EXPECT_EQ(curve.read_bytes[0], 16u);
  EXPECT_EQ(curve.first_read_bytes[0], 16u);
  EXPECT_EQ(curve.write_stays[0], 4u);  // 1, 2, 3 and 2 again
  EXPECT_EQ(curve.write_stays[1], 3u);
  EXPECT_EQ(curve.read_stays[0], 1u);
}

TEST(Reuse, StreamsThatShareACachePushEachOtherOut) {
  std::vector<BlockAccess> accesses;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    accesses.push_back({i, static_cast<std::uint32_t>(i % 12), kTexture, 4, 0});
    accesses.push_back({i, static_cast<std::uint32_t>(i % 12), ReuseStream::depth, 64, 0});
  }
  const ReuseProfile profile = analyze(accesses);
  EXPECT_EQ(profile.apart[index_of(kTexture)].read_bytes[0], 12u * 64);  // 768 bytes fit
  EXPECT_EQ(profile.shared[index_of(kTexture)].read_bytes[0], 1000u * 64);
  EXPECT_EQ(profile.shared[index_of(kTexture)].read_bytes[1], 12u * 64);
}

TEST(Reuse, OrderIsThatOfTheAccessesWhoeverNotedThem) {
  std::vector<BlockAccess> reads = wandering_reads(500, 4000, 3);
  const ReuseProfile in_order = analyze(reads);
  std::stable_partition(reads.begin(), reads.end(), [](const BlockAccess& a) { return a.order % 7 < 3; });
  EXPECT_EQ(analyze(reads), in_order);
}

// The error on a grid of cache sizes; docs/hardware_model.md quotes it.
TEST(Reuse, ASampleOfOneBlockInThirtyTwoIsWithinAFewPercent) {
  constexpr std::uint32_t kLines = 60'000;
  double worst = 0.0, sum = 0.0;
  int cells = 0;
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const std::vector<BlockAccess> reads = wandering_reads(kLines, 150'000, seed);
    BlockKinds kinds;
    const MissCurve exact = analyze(reads, kinds).apart[index_of(kTexture)];
    kinds[index_of(kTexture)].shift = 5;
    const MissCurve sampled = analyze(sample_of(reads, 5), kinds).apart[index_of(kTexture)];
    for (std::size_t k = 3; k < 13; ++k) {  // 8 KiB to 4 MiB
      const auto all = static_cast<double>(reads.size());
      const double error =
          std::abs(static_cast<double>(sampled.read_bytes[k]) - static_cast<double>(exact.read_bytes[k])) /
          64.0 / all;
      worst = std::max(worst, error);
      sum += error;
      ++cells;
    }
  }
  RecordProperty("mean_error_ppm", static_cast<int>(1e6 * sum / cells));
  RecordProperty("worst_error_ppm", static_cast<int>(1e6 * worst));
  std::printf("sampled 1 in 32: mean error of the miss ratio %.4f, worst %.4f\n", sum / cells, worst);
  EXPECT_LT(sum / cells, 0.025);
  EXPECT_LT(worst, 0.04);
}

TEST(Reuse, SetsOfEightWaysMissLittleMoreThanFullAssociativity) {
  const std::vector<BlockAccess> reads = wandering_reads(60'000, 200'000, 9);
  for (const std::size_t kib : {16u, 64u, 256u, 1024u}) {
    SetAssociativeCache sets(kib * 1024, 64, 8), full(kib * 1024, 64, kib * 16);
    if (kib > 64) continue;  // the list of a large fully associative cache is slow: the curve stands for it
    double by_sets = 0.0, by_full = 0.0;
    for (const BlockAccess& a : reads)
      by_sets += sets.access(a.block) ? 0 : 1, by_full += full.access(a.block) ? 0 : 1;
    EXPECT_NEAR(by_sets / by_full, 1.0, 0.05) << kib << " KiB";
  }
}

// What the engines use against what hardware would do: a sample of the blocks, a curve for fully associative
// caches, and the exact simulation of sets with ways.
TEST(Reuse, ASampledCurveIsNearExactCachesOfEverySizeAndAssociativity) {
  const std::vector<BlockAccess> reads = wandering_reads(60'000, 150'000, 4);
  BlockKinds kinds;
  kinds[index_of(kTexture)].shift = 5;
  const MissCurve curve = analyze(sample_of(reads, 5), kinds).apart[index_of(kTexture)];
  const auto all = static_cast<double>(reads.size());
  double worst = 0.0, sum = 0.0;
  int cells = 0;
  for (const std::size_t ways : {4u, 8u, 16u})
    for (std::size_t k = 3; k < 12; ++k) {  // 8 KiB to 2 MiB
      SetAssociativeCache cache(std::size_t{1024} << k, 64, ways);
      double misses = 0.0;
      for (const BlockAccess& a : reads) misses += cache.access(a.block) ? 0.0 : 1.0;
      const double error = std::abs(static_cast<double>(curve.read_bytes[k]) / 64.0 - misses) / all;
      worst = std::max(worst, error);
      sum += error;
      ++cells;
    }
  std::printf("against set-associative caches: mean error of the miss ratio %.4f, worst %.4f\n", sum / cells,
              worst);
  EXPECT_LT(sum / cells, 0.03);
  EXPECT_LT(worst, 0.06);
}

TEST(RecentBlocks, SaysWhichFirstLevelCachesMiss) {
  RecentBlocks recent;
  recent.start(0);
  for (std::uint32_t block = 0; block < 40; ++block) EXPECT_EQ(recent.missing_sizes(block, 64), kCacheSizes);
  EXPECT_EQ(recent.missing_sizes(39, 64), 0);
  EXPECT_EQ(recent.missing_sizes(24, 64), 0);  // the 16th: 1 KiB
  EXPECT_EQ(recent.missing_sizes(22, 64), 1);  // beyond: 39, 24 and 15 more
  recent.clear();
  EXPECT_EQ(recent.missing_sizes(22, 64), kCacheSizes);
}

TEST(RecentBlocks, ForgetsWhatIsBeyondItsWindow) {
  RecentBlocks recent;
  recent.start(5);  // 256 KiB are 128 sampled lines
  for (std::uint32_t block = 0; block < 200; ++block) recent.missing_sizes(block, 64);
  EXPECT_EQ(recent.missing_sizes(100, 64), 8);  // 99 sampled lines in between, 32 each: 198 KiB
  EXPECT_EQ(recent.missing_sizes(10, 64), kCacheSizes);
}

TEST(MovedRatio, IsLinearBetweenSizesAndOneWhereNothingIsKnown) {
  std::array<std::uint64_t, kCacheSizes> bytes{};
  bytes[0] = 800;
  bytes[1] = 400;
  EXPECT_DOUBLE_EQ(moved_ratio(bytes, 1000, 512.0), 0.8);
  EXPECT_DOUBLE_EQ(moved_ratio(bytes, 1000, 1024.0), 0.8);
  EXPECT_DOUBLE_EQ(moved_ratio(bytes, 1000, 1536.0), 0.6);
  EXPECT_DOUBLE_EQ(moved_ratio(bytes, 1000, 2048.0), 0.4);
  EXPECT_DOUBLE_EQ(moved_ratio(bytes, 1000, 1e12), 0.0);
  EXPECT_DOUBLE_EQ(moved_ratio(bytes, 0, 1024.0), 1.0);
}

TEST(Reuse, ClearedTargetsNeverReadLessThanNothing) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 100000; ++i) {
    MissCurve curve;
    curve.requested_read_bytes = 1 + random() % 1000000;
    std::uint64_t later = 1 + random() % 100000;  // reads of what was there before, none from some size on
    for (std::size_t k = 0; k < kCacheSizes; ++k, later /= 3) {
      curve.first_read_bytes[k] = random() % 100000;
      curve.read_bytes[k] = curve.first_read_bytes[k] + later;
    }
    const double cache_bytes =
        1024.0 * static_cast<double>(1 << random() % 16);  // ends of lines, where they round
    const double ratio = moved_by(curve, cache_bytes, true).read;
    ASSERT_GE(ratio, 0.0) << cache_bytes;
    ASSERT_LE(ratio * static_cast<double>(curve.requested_read_bytes), 100000.0 * 1.0001) << cache_bytes;
  }
}

}  // namespace
}  // namespace hwsim
