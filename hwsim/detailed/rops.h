#pragma once
// The units behind the cores: a packet waits in the queue before them, moves its lines, is blended and
// resolved.
#include <cstdint>
#include <vector>

#include "hwsim/detailed/unit_lines.h"

namespace hwsim {

class Rops {
 public:
  explicit Rops(Surroundings& around);
  struct Leaving {
    double accepted_ns, done_ns;  ///< when the queue took the packet over, and when it is written
  };
  Leaving finish(const ChunkPackets& chunk, double now);
  std::uint64_t finished() const { return finished_; }
  double free_ns() const { return crop_free_ns_; }
  double crop_busy_ns() const { return crop_busy_ns_; }
  double resolve_busy_ns() const { return resolve_busy_ns_; }

 private:
  UnitLines lines_;
  std::vector<double> done_ns_;  ///< when the last packets were written, by number modulo the queue
  std::uint64_t finished_ = 0;
  double crop_free_ns_ = 0.0, resolve_free_ns_ = 0.0, crop_busy_ns_ = 0.0, resolve_busy_ns_ = 0.0;
};

}  // namespace hwsim
