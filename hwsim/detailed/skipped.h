#pragma once
// What the caches see of packets that are not simulated.
#include <cstdint>
#include <vector>

#include "hwsim/detailed/surroundings.h"

namespace hwsim {

struct SkippedLines {
  StreamBytesOf<double> l2;  ///< lines that L2 is asked for, by stream
  double l1_lookups = 0.0;   ///< texture lines that each core looks up
};

/// Packets [first, last) of the plan; `l1_missing`: the part of the lookups that L1 does not have.
SkippedLines skipped_lines(const PacketPlan& plan, std::uint64_t first, std::uint64_t last, double cores,
                           double l1_missing);

/// The same as accesses to lines beyond the reach of the DRAM's reordering, by client.
std::vector<MemorySystem::Passing> passing_by(const Surroundings& around, const StreamBytesOf<double>& lines);

}  // namespace hwsim
