#pragma once
// What a worker notes about the memory accesses of a pass: accesses to a sample of all blocks, for the reuse
// distances of hwsim/trace/reuse.h, and how many atomics went to each address.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hwsim/trace/reuse.h"

namespace hwsim::pipeline {

inline constexpr std::uint32_t kLineBytes = 64;

/// Accesses of a stream that are kept: bounds the memory that noting a pass takes, and the time that
/// analyzing it takes.
inline constexpr std::size_t kAccessesMax = 32768;

struct AccessTracker {
  static constexpr std::size_t kAtomicSlots = 16384;
  static constexpr std::size_t kQuads = 16;  ///< a batch of 64 lanes has as many

  BlockKinds kinds;  ///< what is followed: with the sample that the pass began with
  /// The sample is halved whenever a stream has more than the most that are kept: the analysis would drop
  /// these accesses too (make_reuse_profile).
  std::vector<BlockAccess> accesses;
  BlockKinds kept;  ///< the samples of `accesses`
  /// Texture accesses by the number of first-level cache sizes (hwsim/trace/reuse.h) that miss them.
  std::array<std::uint64_t, kCacheSizes + 1> l1_missing{};
  /// Two addresses in one slot add up: that overrates the most frequent address by a 16384th of all atomics,
  /// which takes a small part of their time where addresses differ.
  std::vector<std::uint32_t> atomics;

  /// `accesses_max`: kAccessesMax, or SIZE_MAX for all.
  void start_pass(const BlockKinds& block_kinds, bool storage, std::size_t accesses_max) {
    kinds = kept = block_kinds;
    accesses_max_ = accesses_max;
    accesses.clear();
    counts_.fill(0);
    any_ = last_is_kept_ = false;
    l1_missing.fill(0);
    recent_.start(kinds[index_of(ReuseStream::texture)].shift);
    atomics.assign(storage ? kAtomicSlots : 0, 0);
  }
  /// A screen bin or a group: the first-level cache starts cold.
  void start_bin(std::uint32_t bin) {
    bin_ = bin;
    primitive_ = 0;
    recent_.clear();
  }
  void start_primitive(std::uint32_t primitive) { primitive_ = primitive; }

  /// Quads that share a register fetch in turn, others after each other: accesses of a batch count quad by
  /// quad, whatever the register's width. The block is one of the sample.
  void use(int quad, ReuseStream stream, std::uint32_t block, std::uint32_t read, std::uint32_t write) {
    batch_[static_cast<std::size_t>(quad) % kQuads].push_back({0, block, stream, read, write});
  }
  void use_if_sampled(int quad, ReuseStream stream, std::uint32_t block, std::uint32_t read,
                      std::uint32_t write) {
    if (is_sampled(block, kinds[index_of(stream)].shift)) use(quad, stream, block, read, write);
  }
  void end_batch() {
    for (std::vector<BlockAccess>& quad : batch_) {
      for (const BlockAccess& a : quad) {
        if (a.stream == ReuseStream::texture)
          l1_missing[static_cast<std::size_t>(recent_.missing_sizes(a.block, kLineBytes))] += 1;
        touch(a.stream, a.block, a.read_bytes, a.write_bytes);
      }
      quad.clear();
    }
  }
  /// At once, in the order of the calls; the block is one of the sample.
  void touch(ReuseStream stream, std::uint32_t block, std::uint32_t read, std::uint32_t write) {
    const std::uint64_t order = std::uint64_t{primitive_} << 32 | bin_;
    const bool again = last_.block == block && last_.stream == stream && last_.order == order;
    if (again && any_) {
      if (!last_is_kept_) return;
      accesses.back().read_bytes += read;
      accesses.back().write_bytes += write;
      return;
    }
    any_ = true;
    last_ = {order, block, stream, read, write};
    last_is_kept_ = is_sampled(block, kept[index_of(stream)].shift);
    if (!last_is_kept_) return;
    accesses.push_back(last_);
    if (++counts_[index_of(stream)] > accesses_max_) halve(stream);
  }
  void touch_if_sampled(ReuseStream stream, std::uint32_t block, std::uint64_t read, std::uint64_t write) {
    if (is_sampled(block, kinds[index_of(stream)].shift))
      touch(stream, block, static_cast<std::uint32_t>(read), static_cast<std::uint32_t>(write));
  }
  void count_atomic(int buffer, std::int32_t word) {
    const std::uint32_t key = static_cast<std::uint32_t>(word) * 4 + static_cast<std::uint32_t>(buffer);
    if (!atomics.empty()) atomics[key * 0x9e3779b1u >> 18] += 1;
  }

 private:
  /// Drops every other sampled block of the stream, until few enough accesses are left.
  void halve(ReuseStream stream);

  RecentBlocks recent_;
  std::size_t accesses_max_ = kAccessesMax;
  std::array<std::size_t, kReuseStreams> counts_{};  ///< accesses kept of each stream
  BlockAccess last_;                                 ///< kept or not
  bool any_ = false, last_is_kept_ = false;
  std::array<std::vector<BlockAccess>, kQuads> batch_;
  std::uint32_t bin_ = 0, primitive_ = 0;
};

/// Numbers of blocks of a stream that has several sources: each buffer begins at a place of its own.
constexpr std::uint32_t buffer_line(int slot, std::uint32_t word) {
  return (static_cast<std::uint32_t>(slot) << 28) + word / (kLineBytes / 4);
}

/// One block in 2^shift so that about a thousand or more of `blocks` are sampled, and at most 1 in 32.
constexpr int sample_shift(std::uint64_t blocks, int shift_max) {
  int shift = 0;
  while (shift < shift_max && blocks >> shift >= 2048) ++shift;
  return shift;
}

/// Profile of a pass from what its workers noted, whose accesses it takes. The same for any number of
/// workers: a sample that is too large for one of them is too large for all together.
ReuseProfile make_reuse_profile(std::span<AccessTracker* const> workers, bool exact, int jobs);

}  // namespace hwsim::pipeline
