#pragma once
// A server whose requests are not made in the order of their times.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hwsim {

/// Time in slots, each with what is left of it. A request takes the first time
/// that is free from its own on, so a request that is made late for an early
/// time does not wait for later ones. Units run ahead of each other in
/// simulated time by less than a pass, and the events of one are computed
/// before those of the next.
class Calendar {
 public:
  explicit Calendar(double slot_ns) : slot_ns_(slot_ns) {}

  /// When a service of `ns` that could begin at `now` is done.
  double reserve(double now, double ns) {
    if (ns <= 0.0) return now;
    std::size_t slot = free_from(static_cast<std::size_t>(now / slot_ns_));
    double done = now + ns;
    for (double rest = ns; rest > 0.0;) {
      const double part = std::min(rest, slot_ns_ - used_[slot]);
      used_[slot] += part;
      rest -= part;
      done = std::max(done, static_cast<double>(slot) * slot_ns_ + used_[slot]);
      if (used_[slot] < slot_ns_) break;
      next_[slot] = static_cast<std::uint32_t>(slot + 1);
      slot = free_from(slot + 1);
    }
    last_ns_ = std::max(last_ns_, done);
    return done;
  }
  double last_ns() const { return last_ns_; }

 private:
  /// The first slot from `slot` on that has time left; paths are shortened on
  /// the way.
  std::size_t free_from(std::size_t slot) {
    grow(slot);
    std::size_t found = slot;
    while (next_[found] != found) grow(found = next_[found]);
    while (next_[slot] != found && slot != found) {
      const std::size_t after = next_[slot];
      next_[slot] = static_cast<std::uint32_t>(found);
      slot = after;
    }
    return found;
  }
  void grow(std::size_t slot) {
    while (next_.size() <= slot + 1) {
      next_.push_back(static_cast<std::uint32_t>(next_.size()));
      used_.push_back(0.0);
    }
  }

  double slot_ns_, last_ns_ = 0.0;
  std::vector<double> used_;
  std::vector<std::uint32_t> next_;
};

}  // namespace hwsim
