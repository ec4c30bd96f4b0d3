#include "hwsim/detailed/machine.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "hwsim/detailed/skipped.h"

namespace hwsim {

Machine::Machine(const PassWork& pass, const PacketPlan& plan, const GpuConfig& gpu,
                 const GpuRates<double>& rates, std::uint64_t events_without_progress_max, std::uint64_t seed)
    : around_(pass, plan, gpu, rates, seed),
      front_(around_),
      cores_(around_),
      rops_(around_),
      events_max_(events_without_progress_max) {}

Machine::Progress Machine::enter_until(std::uint64_t last) {
  while (next_ < last) {
    if (enter(next_)) {
      ++next_;
      continue;
    }
    if (around_.events.empty()) stall(next_);
    handle_next();
  }
  return progress(dispatched_ns_);
}

Machine::Progress Machine::drain() {
  while (!around_.events.empty()) handle_next();
  return progress(std::max(last_ns_, memory().dram().free_ns()));
}

void Machine::handle_next() {
  const Event event = around_.events.pop();
  now_ns_ = event.ns;
  if (event.step == Step::leave)
    leave(event.subgroup, event.ns);
  else if (event.step == Step::release)
    cores_.release(event.subgroup);
  else
    cores_.handle(event);
  if (++events_since_progress_ > events_max_) stall(next_);
}

bool Machine::enter(std::uint64_t packet) {
  const ChunkPackets& chunk = around_.plan.chunk_of(packet);
  const std::uint64_t in_chunk = packet - chunk.first;
  // Subgroups are spread evenly over the packets of the chunk.
  const double per_packet = chunk.subgroups / static_cast<double>(chunk.count);
  const bool shades = std::floor(static_cast<double>(in_chunk + 1) * per_packet + 1e-9) >
                      std::floor(static_cast<double>(in_chunk) * per_packet + 1e-9);
  const std::optional<std::size_t> core = shades ? cores_.pick(chunk) : std::nullopt;
  if (shades && !core) return false;
  const double ready = front_.take(chunk);
  if (core) {
    const double start = std::max(ready, now_ns_);
    dispatched_ns_ = std::max(dispatched_ns_, start);
    front_.hand_over(start);
    cores_.dispatch(chunk, *core, start);
    return true;
  }
  // In a chunk that shades, only subgroups have work behind the cores.
  const Rops::Leaving out = chunk.subgroups > 0.0 ? Rops::Leaving{ready, ready} : rops_.finish(chunk, ready);
  dispatched_ns_ = std::max(dispatched_ns_, out.accepted_ns);
  front_.hand_over(out.accepted_ns);
  last_ns_ = std::max(last_ns_, out.done_ns);
  events_since_progress_ = 0;
  return true;
}

// A subgroup holds its place until the queue to the ROPs has room.
void Machine::leave(std::uint32_t subgroup, double now) {
  const Rops::Leaving out = rops_.finish(cores_.chunk_of(subgroup), now);
  last_ns_ = std::max(last_ns_, out.done_ns);
  events_since_progress_ = 0;
  if (out.accepted_ns > now) return around_.events.push(out.accepted_ns, subgroup, Step::release);
  cores_.release(subgroup);
}

Machine::Progress Machine::progress(double ns) const { return {ns, memory().dram_bytes(), busy_ns()}; }

std::array<double, kUnitCount> Machine::busy_ns() const {
  std::array<double, kUnitCount> busy{};
  for (std::size_t u = 0; u < kFrontUnits.size(); ++u) busy[index_of(kFrontUnits[u])] = front_.busy_ns()[u];
  busy[index_of(Unit::shader)] = cores_.shader_busy_ns();
  busy[index_of(Unit::tex)] = cores_.tex_busy_ns();
  busy[index_of(Unit::crop)] = rops_.crop_busy_ns();
  busy[index_of(Unit::resolve)] = rops_.resolve_busy_ns();
  busy[index_of(Unit::l2)] = memory().l2_busy_ns();
  busy[index_of(Unit::dram)] = memory().dram().busy_ns();
  return busy;
}

// Rows, queues and what the cores hold stay as they are.
void Machine::skip_to(std::uint64_t packet) {
  const auto cores = static_cast<double>(cores_.count());
  const SkippedLines skipped = skipped_lines(around_.plan, next_, packet, cores, cores_.l1_missing());
  around_.memory.pass_by(passing_by(around_, skipped.l2));
  cores_.pass_by(skipped.l1_lookups);
  next_ = packet;
}

void Machine::stall(std::uint64_t packet) const {
  std::string text = "detailed engine: nothing moves in pass \"" + around_.pass.name + "\" at packet " +
                     std::to_string(packet) + " of " + std::to_string(around_.plan.packets) + ", " +
                     std::to_string(now_ns_) + " ns; entered " + std::to_string(front_.taken()) +
                     ", finished " + std::to_string(rops_.finished()) + "; free at (ns):";
  for (std::size_t u = 0; u < kFrontUnits.size(); ++u)
    text += " " + std::string(unit_name(kFrontUnits[u])) + " " + std::to_string(front_.free_ns()[u]);
  text += " crop " + std::to_string(rops_.free_ns()) + " l2 " + std::to_string(memory().l2_free_ns()) +
          " dram " + std::to_string(memory().dram().free_ns()) + "; resident subgroups of the cores:";
  for (const int residents : cores_.residents()) text += " " + std::to_string(residents);
  throw StallError(text);
}

}  // namespace hwsim
