#pragma once
// A pass as a sequence of packets: a subgroup's worth of fragments with its share of everything that the
// chunk makes the other units do. The trace has no finer order than chunks; within one, work is spread
// evenly.
#include <cstdint>
#include <vector>

#include "hwsim/timing/time_pass.h"

namespace hwsim {

/// What a subgroup does in the cores, all of them of one chunk alike.
struct SubgroupWork {
  double alu_ns = 0.0, sfu_ns = 0.0, memory_pipe_ns = 0.0, atomic_ns = 0.0,
         tex_ns = 0.0;  ///< times of one core
  double alu_chain_ns = 0.0;
  double memory_phases = 0.0;
  double l1_lines = 0.0;       ///< texture lines looked up in L1
  double storage_lines = 0.0;  ///< read from L2
};

struct ChunkPackets {
  std::uint64_t first = 0, count = 0;  ///< packets
  double subgroups = 0.0;
  double leaving_packets =
      1.0;                ///< that the ROPs' work of a leaving one stands for: only subgroups bring them any
  double resident = 1.0;  ///< subgroups of this kind that a core holds
  std::array<double, kUnitCount> service_ns{};  ///< times of one packet in units that all packets go through
  SubgroupWork work;
  double expected_ns = 0.0,
         expected_bytes = 0.0;  ///< time and bytes of a packet by the closed forms: what samples weigh
  double in_flight = 1.0;       ///< packets of this kind that the machine holds at once in a steady state
  StreamBytesOf<double> l2, direct;  ///< bytes of a packet that L2 is asked for, and that pass it by
};

struct PacketPlan {
  std::vector<ChunkPackets> chunks;
  /// The part of what was asked for, compressed as DRAM sees it, that the caches before L2 let through.
  StreamBytesOf<double> reaches_l2;
  StreamBytesOf<double> run_lines;  ///< neighboring lines that are asked for together
  double l1_asked = 1.0;
  std::uint64_t packets = 0;
  const ChunkPackets& chunk_of(std::uint64_t packet) const;
};

PacketPlan plan_packets(const PassWork& pass, const GpuRates<double>& rates);

}  // namespace hwsim
