#include "hwsim/detailed/rops.h"

#include <algorithm>

namespace hwsim {

Rops::Rops(Surroundings& around)
    : lines_(around), done_ns_(static_cast<std::size_t>(around.rates.queue_packets), 0.0) {}

Rops::Leaving Rops::finish(const ChunkPackets& chunk, double now) {
  const auto serve = [](double& free_ns, double& busy_ns, double start, double service_ns) {
    busy_ns += service_ns;
    return free_ns = std::max(free_ns, start) + service_ns;
  };
  const std::size_t slot = finished_ % done_ns_.size();
  const double accepted = finished_ >= done_ns_.size() ? std::max(now, done_ns_[slot]) : now;
  ++finished_;
  const double packets = chunk.leaving_packets;
  double start = std::max(accepted, crop_free_ns_);
  start = lines_.move(chunk, info(Unit::crop).streams, packets, start);
  const double stored = chunk.l2.write[index_of(Stream::storage)] * packets;
  start = lines_.move_bytes(Stream::storage, stored, true, false, start);
  double done = serve(crop_free_ns_, crop_busy_ns_, start, chunk.service_ns[index_of(Unit::crop)] * packets);
  const double resolve_ns = chunk.service_ns[index_of(Unit::resolve)] * packets;
  if (resolve_ns > 0.0) done = std::max(done, serve(resolve_free_ns_, resolve_busy_ns_, start, resolve_ns));
  done_ns_[slot] = done;
  return {accepted, done};
}

}  // namespace hwsim
