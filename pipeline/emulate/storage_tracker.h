#pragma once
// What a worker notes about the storage accesses of a pass.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hwsim::pipeline {

/// How many atomics went to each address, by a hash of it: sums do not depend on the order of the lanes. Two
/// addresses in one of the 16384 slots add up; that overrates the most frequent address by a 16384th of all
/// atomics, which takes a small part of their time where addresses differ.
struct StorageTracker {
  static constexpr std::size_t kSlots = 16384;
  std::vector<std::uint32_t> atomics;

  void start() { atomics.assign(kSlots, 0); }
  void count_atomic(int buffer, std::int32_t word) {
    const std::uint32_t key = static_cast<std::uint32_t>(word) * 4 + static_cast<std::uint32_t>(buffer);
    atomics[key * 0x9e3779b1u >> 18] += 1;
  }
};

}  // namespace hwsim::pipeline
