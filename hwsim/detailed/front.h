#pragma once
// The units that every packet goes through before the cores take it, in order, with a queue behind each.
#include <array>
#include <cstdint>
#include <vector>

#include "hwsim/detailed/unit_lines.h"

namespace hwsim {

inline constexpr auto kFrontUnits = units_of<UnitPlace::front>();

class Front {
 public:
  explicit Front(Surroundings& around);
  /// Takes the next packet through all units; returns when the last of them has done it. A unit starts a
  /// packet when it has it, is free, and the queue behind it has room: the unit after it has done the packet
  /// that came so many before.
  double take(const ChunkPackets& chunk);
  /// The packet that was taken last left the queue behind the front.
  void hand_over(double ns);
  std::uint64_t taken() const { return taken_; }
  /// When each unit is free, and how long it worked, in the order of kFrontUnits.
  const std::array<double, kFrontUnits.size()>& free_ns() const { return free_ns_; }
  const std::array<double, kFrontUnits.size()>& busy_ns() const { return busy_ns_; }

 private:
  std::size_t queue_packets_;  ///< between two units
  std::vector<UnitLines> lines_;
  std::array<double, kFrontUnits.size()> free_ns_{}, busy_ns_{};
  /// When each unit has done the last packets, by number modulo the queue; the last: when they left the
  /// front.
  std::array<std::vector<double>, kFrontUnits.size() + 1> done_ns_;
  std::uint64_t taken_ = 0;
};

}  // namespace hwsim
