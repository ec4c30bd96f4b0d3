#include "hwsim/detailed/unit_lines.h"

#include <algorithm>

namespace hwsim {

double UnitLines::move(const ChunkPackets& chunk, StreamSet streams, double packets, double now) {
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    if (!holds(streams, i)) continue;
    const auto stream = static_cast<Stream>(i);
    now = move_bytes(stream, packets * chunk.l2.read[i], false, false, now);
    now = move_bytes(stream, packets * chunk.l2.write[i], true, false, now);
    now = move_bytes(stream, packets * chunk.direct.read[i], false, true, now);
    now = move_bytes(stream, packets * chunk.direct.write[i], true, true, now);
  }
  return now;
}

double UnitLines::move_bytes(Stream stream, double bytes, bool write, bool bypass, double now) {
  static constexpr Survival kAlwaysNew = [] {
    Survival all{};
    all.fill(1.0);
    return all;
  }();
  if (bytes <= 0.0) return now;
  const Survival& survival = bypass ? kAlwaysNew : around_.survival_of(index_of(stream), write);
  const double run_lines = around_.run_lines(index_of(stream), write);
  const double lines = around_.whole(bytes / kTextureLineBytes);
  for (double i = 0.0; i < lines; i += 1.0) {
    while (!arrive_ns_.empty() && arrive_ns_.front() <= now) arrive_ns_.pop_front();
    if (arrive_ns_.size() >= lines_max_) {
      now = std::max(now, arrive_ns_.front());
      arrive_ns_.pop_front();
    }
    arrive_ns_.push_back(
        around_.memory.access(client_of(stream), stream, survival, run_lines, write, bypass, now));
  }
  return now;
}

}  // namespace hwsim
