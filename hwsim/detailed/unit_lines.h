#pragma once
// Lines that a fixed-function unit has on their way: it looks ahead as far as its buffers go.
#include <cstddef>
#include <deque>

#include "hwsim/detailed/surroundings.h"

namespace hwsim {

class UnitLines {
 public:
  explicit UnitLines(Surroundings& around)
      : around_(around), lines_max_(static_cast<std::size_t>(around.rates.unit_lines)) {}

  /// Asks for what `packets` packets of the chunk move of the streams, from `now` on; returns when the last
  /// of the lines could be asked for.
  double move(const ChunkPackets& chunk, StreamSet streams, double packets, double now);
  /// Bytes of one stream, through L2 or (`bypass`) straight to DRAM.
  double move_bytes(Stream stream, double bytes, bool write, bool bypass, double now);

 private:
  Surroundings& around_;
  std::size_t lines_max_;
  std::deque<double> arrive_ns_;  ///< when the lines on their way arrive
};

}  // namespace hwsim
