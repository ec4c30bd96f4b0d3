#pragma once
// The event-driven engine, whole or on a sample of a pass.
#include <array>
#include <cstdint>
#include <optional>

#include "hwsim/detailed/machine.h"

namespace hwsim {

struct DetailedTime {
  PassTime<double> time;
  std::optional<std::array<double, 2>> interval_ns;  ///< 90 %, of the sampling alone
  std::uint64_t packets = 0, simulated_packets = 0;
};

/// Throws StallError.
DetailedTime detailed_time(const PassWork& pass, const GpuConfig& gpu, const GpuRates<double>& rates,
                           const TimingOptions& options, std::uint64_t seed);

}  // namespace hwsim
