#pragma once
// The clock of the detailed engine: packets enter the front, subgroups live in the cores and leave through
// the ROPs, all of them over one memory; events in the order of their time.
#include <array>
#include <cstdint>
#include <stdexcept>

#include "hwsim/detailed/cores.h"
#include "hwsim/detailed/front.h"
#include "hwsim/detailed/rops.h"

namespace hwsim {

/// Nothing moves any more: an error of the simulator, with the pass, the unit and the state of the queues.
class StallError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Machine {
 public:
  Machine(const PassWork& pass, const PacketPlan& plan, const GpuConfig& gpu, const GpuRates<double>& rates,
          std::uint64_t events_without_progress_max, std::uint64_t seed);

  /// What was simulated so far: until when, and what was moved and done by then.
  struct Progress {
    double ns = 0.0;
    StreamBytesOf<double> bytes;
    std::array<double, kUnitCount> busy_ns{};
  };
  /// Simulates the next packets up to `last`; returns how it stands when the last of them is dispatched.
  Progress enter_until(std::uint64_t last);
  /// The next packet is `packet`: those between leave what the caches would remember of them, and no more.
  void skip_to(std::uint64_t packet);
  /// Everything that entered leaves.
  Progress drain();
  const MemorySystem& memory() const { return around_.memory; }

 private:
  bool enter(std::uint64_t packet);
  void handle_next();
  void leave(std::uint32_t subgroup, double now);
  Progress progress(double ns) const;
  std::array<double, kUnitCount> busy_ns() const;
  [[noreturn]] void stall(std::uint64_t packet) const;

  Surroundings around_;
  Front front_;
  Cores cores_;
  Rops rops_;
  std::uint64_t events_max_, events_since_progress_ = 0;
  std::uint64_t next_ = 0;  ///< packet
  double now_ns_ = 0.0, dispatched_ns_ = 0.0, last_ns_ = 0.0;
};

}  // namespace hwsim
