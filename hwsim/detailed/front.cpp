#include "hwsim/detailed/front.h"

#include <algorithm>

namespace hwsim {

Front::Front(Surroundings& around)
    : queue_packets_(static_cast<std::size_t>(around.rates.queue_packets)),
      lines_(kFrontUnits.size(), UnitLines(around)) {
  for (std::vector<double>& ring : done_ns_) ring.assign(queue_packets_, 0.0);
}

double Front::take(const ChunkPackets& chunk) {
  const std::size_t slot = taken_ % queue_packets_;
  double ready = 0.0;
  for (std::size_t u = 0; u < kFrontUnits.size(); ++u) {
    double start = ready;
    if (taken_ >= queue_packets_) start = std::max(start, done_ns_[u + 1][slot]);
    start = std::max(start, free_ns_[u]);
    start = lines_[u].move(chunk, info(kFrontUnits[u]).streams, 1.0, start);
    const double service_ns = chunk.service_ns[index_of(kFrontUnits[u])];
    ready = free_ns_[u] = std::max(free_ns_[u], start) + service_ns;
    busy_ns_[u] += service_ns;
    done_ns_[u][slot] = ready;
  }
  return ready;
}

void Front::hand_over(double ns) {
  done_ns_.back()[taken_ % queue_packets_] = ns;
  ++taken_;
}

}  // namespace hwsim
