#pragma once
// Line addresses whose reuse distances follow a curve of the trace: the trace keeps distances, not addresses.
#include <array>
#include <cstdint>
#include <vector>

#include "hwsim/trace/reuse.h"

namespace hwsim {

/// A small, fast, seeded generator (splitmix64): the same numbers on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  double ratio() { return static_cast<double>(bits() >> 11) * 0x1p-53; }  ///< [0, 1)

 private:
  std::uint64_t state_;
};

/// Lines in the order of their last use, with the one at any depth in logarithmic time.
class LruStack {
 public:
  explicit LruStack(std::size_t lines_max);
  std::size_t size() const { return count_; }
  /// Returns whether the oldest line had to go.
  bool push(std::uint64_t line);
  /// Takes the line of a rank (0: the oldest) to the top.
  std::uint64_t reuse(std::size_t rank);

 private:
  void append(std::uint64_t line);
  void set(std::size_t position, bool present);
  std::size_t place_of(std::size_t rank) const;  ///< position of the rank-th present line from the oldest
  void compact();

  std::size_t lines_max_, count_ = 0, end_ = 0;
  std::vector<std::uint64_t> lines_;
  std::vector<std::uint64_t> present_;  ///< a bit a position
  std::vector<std::int32_t> sums_;      ///< sums of the bits of each word, as a tree (Fenwick 1994)
};

/// The part of requests beyond each size, of the part `reached` of all requests that a cache before it let
/// through.
using Survival = std::array<double, static_cast<std::size_t>(kCacheSizes)>;
Survival survival(const std::array<std::uint64_t, kCacheSizes>& bytes, std::uint64_t requested,
                  double reached);

/// The part of what is asked for that a cache of so many lines does not have; sizes between are interpolated.
double missing(const Survival& survival, double lines);

/// A stream of line numbers. `lines_max`: distances beyond are as good as new lines.
class AddressSource {
 public:
  AddressSource(std::uint64_t first_line, std::size_t lines_max, std::uint64_t seed)
      : next_(first_line), stack_(lines_max), random_(seed) {}
  /// `run_lines`: blocks of so many lines come and go together, so what one of them was asked for, its
  /// neighbors are asked for next. Reads and writes are at blocks of their own. Only distances from
  /// `nearest_lines` on are drawn.
  std::uint64_t next(const Survival& survival, bool write, double run_lines, double nearest_lines);
  /// A line that was not used before; those that follow each other are neighbors.
  std::uint64_t fresh();
  std::size_t lines() const { return stack_.size(); }

 private:
  struct Run {
    double left = 0.0;
    bool fresh = true;
    std::size_t rank = 0;  ///< in the stack, of the line that comes next
  };
  void start(Run& run, const Survival& survival, double nearest_lines);
  void taken(std::size_t rank);

  std::uint64_t next_;
  LruStack stack_;
  Random random_;
  std::array<Run, 2> runs_;
};

}  // namespace hwsim
