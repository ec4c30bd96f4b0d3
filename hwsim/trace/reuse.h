#pragma once
// Which bytes a cache of any size lets through: from reuse distances of a sample of all blocks, chosen by a
// hash of their numbers as in SHARDS (Waldspurger et al., FAST '15). A block is sampled always or never, so
// distances between sampled blocks, scaled by the rate, are distances between all of them.
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace hwsim {

/// Sizes for which traffic is kept: 1 KiB, 2 KiB ... 128 MiB.
inline constexpr int kCacheSizes = 18;
inline constexpr double kSmallestCacheBytes = 1024.0;

/// Bytes that a fully associative LRU cache with write-back exchanges with the memory behind it, by size.
struct MissCurve {
  std::uint64_t requested_read_bytes = 0;
  std::uint64_t requested_write_bytes = 0;
  std::array<std::uint64_t, kCacheSizes> read_bytes{};
  std::array<std::uint64_t, kCacheSizes>
      first_read_bytes{};  ///< the bytes among these that belong to a block's first stay
  std::array<std::uint64_t, kCacheSizes> write_bytes{};
  /// How often a block came in and was read, or left and had been written: bytes a stay decide what
  /// compression saves.
  std::array<std::uint64_t, kCacheSizes> read_stays{}, write_stays{};
  bool operator==(const MissCurve&) const = default;
};

enum class ReuseStream : std::uint8_t { color, depth, texture, storage, geometry };
inline constexpr int kReuseStreams = 5;
constexpr std::size_t index_of(ReuseStream stream) { return static_cast<std::size_t>(stream); }

struct ReuseProfile {
  std::array<MissCurve, kReuseStreams> shared;  ///< one cache for all streams
  std::array<MissCurve, kReuseStreams> apart;   ///< color alone, depth alone, the other three together
  MissCurve texture_l1;                         ///< a core's cache, cold at each screen bin or group
  bool operator==(const ReuseProfile&) const = default;
};

/// Part of the bytes that move, linear between the sizes kept. One where nothing is known of the stream.
template <class T>
T moved_ratio(const std::array<std::uint64_t, kCacheSizes>& bytes, std::uint64_t requested,
              const T& cache_bytes) {
  if (requested == 0) return T(1.0);
  const double all = static_cast<double>(requested);
  double size = kSmallestCacheBytes;
  for (std::size_t k = 0; k + 1 < kCacheSizes; ++k, size *= 2.0) {
    if (T(2.0 * size) < cache_bytes) continue;
    const double here = static_cast<double>(bytes[k]) / all, next = static_cast<double>(bytes[k + 1]) / all;
    if (cache_bytes < T(size)) return T(here);
    return here + (cache_bytes - T(size)) * ((next - here) / size);
  }
  return T(static_cast<double>(bytes[kCacheSizes - 1]) / all);
}

/// One access to a sampled block.
struct BlockAccess {
  std::uint64_t order = 0;  ///< accesses are sorted by it, stably
  std::uint32_t block = 0;
  ReuseStream stream = ReuseStream::color;
  std::uint32_t read_bytes = 0, write_bytes = 0;
};

/// A stream's blocks: their size, whether any access moves all of it, and 2^shift blocks for each sampled
/// one.
struct BlockKind {
  std::uint32_t bytes = 64;
  bool whole = true;
  int shift = 0;
};
using BlockKinds = std::array<BlockKind, kReuseStreams>;

/// Whether a block belongs to the sample of 1 in 2^shift. A sample at a larger shift is part of every one at
/// a smaller.
constexpr std::uint32_t block_hash(std::uint32_t block) {
  std::uint32_t h = block * 0x9e3779b1u;
  h ^= h >> 15;
  return h * 0x85ebca77u;
}
constexpr bool is_sampled(std::uint32_t block, int shift) {
  return (block_hash(block) & ~(0xffffffffu >> shift)) == 0;
}

/// Calls part(i) for i in [0, count), in any order or side by side.
using RunParts = std::function<void(std::size_t count, const std::function<void(std::size_t)>& part)>;
void run_in_order(std::size_t count, const std::function<void(std::size_t)>& part);

/// The smallest sample has one block in 2^kShiftMax.
inline constexpr int kShiftMax = 12;

/// The curves of a pass. Streams with more accesses than `accesses_max` are thinned first.
ReuseProfile analyze_reuse(std::vector<BlockAccess> accesses, BlockKinds kinds, std::size_t accesses_max,
                           const RunParts& run_parts = run_in_order);

/// Reuse distances in the small window of a first-level cache: a list of sampled blocks, latest first.
class RecentBlocks {
 public:
  void start(int shift) {
    shift_ = shift;
    latest_.clear();
  }
  void clear() { latest_.clear(); }
  /// The number of sizes of a MissCurve that are too small to still hold the block; all, beyond the window.
  int missing_sizes(std::uint32_t block, std::uint32_t block_bytes);

 private:
  static constexpr std::size_t kWindowBytes = 256 * 1024;
  int shift_ = 0;
  std::vector<std::uint32_t> latest_;
};

/// Sizes of a MissCurve that are smaller than `bytes`.
int sizes_below(std::uint64_t bytes);

/// The exact cache that the curves approximate: sets of ways, least recently used first out.
class SetAssociativeCache {
 public:
  SetAssociativeCache(std::size_t bytes, std::size_t line_bytes, std::size_t ways);
  /// True on a hit. The line is in the cache afterwards.
  bool access(std::uint64_t line);

 private:
  std::size_t sets_, ways_;
  std::vector<std::uint64_t> tags_;  ///< sets_ x ways_, latest first; line + 1, 0: empty
};

}  // namespace hwsim
