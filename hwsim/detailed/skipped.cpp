#include "hwsim/detailed/skipped.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hwsim {

SkippedLines skipped_lines(const PacketPlan& plan, std::uint64_t first, std::uint64_t last, double cores,
                           double l1_missing) {
  SkippedLines skipped;
  for (const ChunkPackets& chunk : plan.chunks) {
    const std::uint64_t from = std::max(first, chunk.first), to = std::min(last, chunk.first + chunk.count);
    if (from >= to) continue;
    const auto n = static_cast<double>(to - from);
    for (std::size_t i = 0; i < kStreamCount; ++i) {
      skipped.l2.read[i] += n * chunk.l2.read[i] / kTextureLineBytes;
      skipped.l2.write[i] += n * chunk.l2.write[i] / kTextureLineBytes;
    }
    const double subgroups = n * chunk.subgroups / static_cast<double>(chunk.count);
    skipped.l2.read[index_of(Stream::storage)] += subgroups * chunk.work.storage_lines;
    skipped.l2.read[index_of(Stream::texture)] += subgroups * chunk.work.l1_lines * l1_missing;
    skipped.l1_lookups += subgroups * chunk.work.l1_lines / cores;
  }
  return skipped;
}

std::vector<MemorySystem::Passing> passing_by(const Surroundings& around,
                                              const StreamBytesOf<double>& lines) {
  struct Asked {  // what a client asks L2 for, how much of it is far
    double lines = 0.0, written = 0.0, far = 0.0;
  };
  std::array<Asked, kMemoryClients> asked{};
  std::vector<MemorySystem::Passing> passing;
  const auto pass_by = [&](std::size_t i, bool write, double count) {
    if (count <= 0.0) return;
    const MemoryClient client = client_of(static_cast<Stream>(i));
    const Survival& survival = around.survival_of(i, write);
    const double far = count * missing(survival, around.memory.near_lines());
    Asked& a = asked[static_cast<std::size_t>(client)];
    a.lines += count;
    a.written += write ? count : 0.0;
    a.far += far;
    passing.push_back({client, &survival, around.run_lines(i, write), far, write, 0.0});
  };
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    pass_by(i, false, lines.read[i]);
    pass_by(i, true, lines.write[i]);
  }
  for (MemorySystem::Passing& p : passing) {  // a line is asked for lines / far times while it is near
    const Asked& a = asked[static_cast<std::size_t>(p.client)];
    if (a.far > 0.0) p.written_ratio = 1.0 - std::pow(1.0 - a.written / a.lines, a.lines / a.far - 1.0);
  }
  return passing;
}

}  // namespace hwsim
