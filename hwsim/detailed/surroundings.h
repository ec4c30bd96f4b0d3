#pragma once
// What the parts of the detailed engine's machine share: the pass and its packets, the GPU, memory, the
// events and one generator of random numbers.
#include <array>
#include <cstdint>

#include "hwsim/detailed/events.h"
#include "hwsim/detailed/memory.h"
#include "hwsim/detailed/packets.h"

namespace hwsim {

struct Surroundings {
  Surroundings(const PassWork& pass_work, const PacketPlan& packet_plan, const GpuConfig& config,
               const GpuRates<double>& gpu_rates, std::uint64_t first_seed);

  const Survival& survival_of(std::size_t stream, bool write) const {
    return (write ? writes : reads)[stream];
  }
  double run_lines(std::size_t stream, bool write) const {
    return (write ? plan.run_lines.write : plan.run_lines.read)[stream];
  }
  /// A whole number that is `mean` on average.
  double whole(double mean);

  const PassWork& pass;
  const PacketPlan& plan;
  const GpuConfig& gpu;
  const GpuRates<double>& rates;
  std::uint64_t seed;
  MemorySystem memory;
  Random random;
  Events events;
  std::array<Survival, kStreamCount> reads, writes;  ///< reuse of the requests that reach L2
};

MemoryClient client_of(Stream stream);

}  // namespace hwsim
