#include "hwsim/detailed/machine.h"

#include <algorithm>
#include <cmath>

namespace hwsim {
namespace {

constexpr std::size_t kLinesMin = 16;
constexpr std::size_t kNoCore = ~std::size_t{0};

MemoryClient client_of(Stream stream) {
  switch (stream) {
    case Stream::color:
      return MemoryClient::color;
    case Stream::depth:
      return MemoryClient::depth;
    case Stream::other:
      return MemoryClient::other;
    default:
      return MemoryClient::reads;
  }
}

const MissCurve& curve_of(const ReuseProfile& reuse, Stream stream) {
  static const MissCurve none;
  switch (stream) {
    case Stream::color:
      return reuse.apart[at(ReuseStream::color)];
    case Stream::depth:
      return reuse.apart[at(ReuseStream::depth)];
    case Stream::texture:
      return reuse.apart[at(ReuseStream::texture)];
    case Stream::storage:
      return reuse.apart[at(ReuseStream::storage)];
    case Stream::vertex:
    case Stream::index:
      return reuse.apart[at(ReuseStream::geometry)];
    default:
      return none;
  }
}

/// The part of the requests that reach L2 beyond each size. First reads of a cleared target are none of
/// DRAM's business.
Survival beyond_l2(const PassWork& pass, const MissCurve& curve, Stream stream, bool write, double reached) {
  if (write) return survival(curve.write_bytes, curve.requested_write_bytes, reached);
  std::array<std::uint64_t, kCacheSizes> bytes = curve.read_bytes;
  const bool cleared = (stream == Stream::color && pass.color_cleared_before) ||
                       (stream == Stream::depth && pass.depth_cleared_before);
  if (cleared)
    for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] -= std::min(bytes[k], curve.first_read_bytes[k]);
  return survival(bytes, curve.requested_read_bytes, reached);
}

std::size_t l1_lines(const GpuRates<double>& r) {
  return std::max(kLinesMin, static_cast<std::size_t>(r.l1_bytes / kTextureLineBytes));
}

}  // namespace

Machine::Machine(const PassWork& pass, const PacketPlan& plan, const GpuConfig& gpu,
                 const GpuRates<double>& rates, std::uint64_t events_without_progress_max, std::uint64_t seed)
    : pass_(pass),
      plan_(plan),
      rates_(rates),
      events_max_(events_without_progress_max),
      unit_lines_max_(static_cast<std::size_t>(rates.unit_lines)),
      fifo_packets_(static_cast<std::size_t>(rates.queue_packets)),
      core_lines_max_(static_cast<std::size_t>(gpu.core_lines_max)),
      memory_(gpu, seed),
      random_(seed ^ 0x5bd1e995),
      l1_survival_(survival(pass.reuse.texture_l1.read_bytes, pass.reuse.texture_l1.requested_read_bytes,
                            plan.l1_asked)) {
  for (Ring& ring : front_done_) ring.assign(fifo_packets_, 0.0);
  leave_done_.assign(fifo_packets_, 0.0);
  const auto cores = static_cast<std::size_t>(rates.shader_cores);
  cores_.reserve(cores);
  for (std::size_t i = 0; i < cores; ++i) cores_.emplace_back(l1_lines(rates), gpu.l1_ways, seed + 100 + i);
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    const auto stream = static_cast<Stream>(i);
    const MissCurve& curve = curve_of(pass.reuse, stream);
    reads_[i] = beyond_l2(pass, curve, stream, false, plan.reaches_l2.read[i]);
    writes_[i] = beyond_l2(pass, curve, stream, true, plan.reaches_l2.write[i]);
  }
}

Machine::Progress Machine::enter_until(std::uint64_t last) {
  while (next_ < last) {
    if (enter(next_)) {
      ++next_;
      continue;
    }
    if (events_.empty()) stall(next_);
    handle_next();
  }
  return progress(dispatched_ns_);
}

Machine::Progress Machine::drain() {
  while (!events_.empty()) handle_next();
  return progress(std::max(last_ns_, memory_.dram().free_ns()));
}

void Machine::handle_next() {
  const Event event = events_.top();
  events_.pop();
  now_ns_ = event.ns;
  handle(event);
  if (++events_since_progress_ > events_max_) stall(next_);
}

Machine::Progress Machine::progress(double ns) const { return {ns, memory_.dram_bytes(), busy_ns()}; }

bool Machine::enter(std::uint64_t packet) {
  const ChunkPackets& chunk = plan_.chunk_of(packet);
  const std::uint64_t in_chunk = packet - chunk.first;
  // Subgroups are spread evenly over the packets of the chunk.
  const double per_packet = chunk.subgroups / static_cast<double>(chunk.count);
  const bool shades = std::floor(static_cast<double>(in_chunk + 1) * per_packet + 1e-9) >
                      std::floor(static_cast<double>(in_chunk) * per_packet + 1e-9);
  const std::size_t core = shades ? pick_core(chunk) : kNoCore;
  if (shades && core == kNoCore) return false;
  const double ready = front(chunk);
  const std::size_t slot = entered_ % fifo_packets_;
  ++entered_;
  if (shades) {
    const double start = std::max(ready, now_ns_);
    dispatched_ns_ = std::max(dispatched_ns_, start);
    front_done_.back()[slot] = start;
    dispatch(chunk, core, start);
    return true;
  }
  // In a chunk that shades, only subgroups have work behind the cores.
  const Leaving out = chunk.subgroups > 0.0 ? Leaving{ready, ready} : finish(chunk, ready);
  dispatched_ns_ = std::max(dispatched_ns_, out.accepted_ns);
  front_done_.back()[slot] = out.accepted_ns;
  last_ns_ = std::max(last_ns_, out.done_ns);
  events_since_progress_ = 0;
  return true;
}

// A unit starts a packet when it has it, is free, and the queue behind it has room: the unit after it has
// done the packet that came so many before.
double Machine::front(const ChunkPackets& chunk) {
  const std::size_t slot = entered_ % fifo_packets_;
  double ready = 0.0;
  for (std::size_t u = 0; u < kFrontUnits.size(); ++u) {
    double start = ready;
    if (entered_ >= fifo_packets_) start = std::max(start, front_done_[u + 1][slot]);
    start = std::max(start, front_free_[u]);
    if (kFrontUnits[u] == Unit::ia)
      start = move(chunk, {Stream::vertex, Stream::index, Stream::constant}, 1.0, start, ia_lines_);
    if (kFrontUnits[u] == Unit::zrop) start = move(chunk, {Stream::depth}, 1.0, start, depth_lines_);
    ready = serve(front_free_[u], start, chunk.service_ns[at(kFrontUnits[u])], kFrontUnits[u]);
    front_done_[u][slot] = ready;
  }
  return ready;
}

double Machine::serve(double& free_ns, double now, double service_ns, Unit unit) {
  free_ns = std::max(free_ns, now) + service_ns;
  busy_ns_[at(unit)] += service_ns;
  return free_ns;
}

/// The core with the fewest residents among those that have room.
std::size_t Machine::pick_core(const ChunkPackets& chunk) const {
  std::size_t best = kNoCore;
  for (std::size_t i = 0; i < cores_.size(); ++i)
    if (cores_[i].resident + 1.0 <= chunk.resident &&
        (best == kNoCore || cores_[i].resident < cores_[best].resident))
      best = i;
  return best;
}

void Machine::dispatch(const ChunkPackets& chunk, std::size_t core, double ns) {
  if (idle_.empty()) {
    idle_.push_back(static_cast<std::uint32_t>(subgroups_.size()));
    subgroups_.emplace_back();
  }
  const std::uint32_t index = idle_.back();
  idle_.pop_back();
  const bool fetches = chunk.work.l1_lines > 0.0 || chunk.work.storage_lines > 0.0 || chunk.work.tex_ns > 0.0;
  const int phases = std::max(fetches ? 1 : 0, static_cast<int>(whole(chunk.work.memory_phases)));
  subgroups_[index] = {&chunk, core, 0, phases, 0.0, 0.0, 0.0, 0.0};
  cores_[core].resident += 1.0;
  push(ns, index, Step::work);
}

void Machine::handle(const Event& event) {
  switch (event.step) {
    case Step::work:
      return work(event.subgroup, event.ns);
    case Step::fetch:
      return fetch(event.subgroup, event.ns);
    case Step::more:
      return ask(cores_[subgroups_[event.subgroup].core], event.ns);
    case Step::leave:
      return leave(event.subgroup, event.ns);
    case Step::release:
      return release(event.subgroup);
  }
}

// Between two requests to memory a subgroup has an equal part of its operations. Pipes take whole parts in
// the order in which they come.
void Machine::work(std::uint32_t index, double now) {
  const Subgroup& s = subgroups_[index];
  const SubgroupWork& w = s.chunk->work;
  Core& core = cores_[s.core];
  const double part = 1.0 / (s.phases + 1);
  double end = now + w.alu_chain_ns * part;
  const auto pipe = [&](double& free_ns, double work_ns, double& busy) {
    if (work_ns <= 0.0) return;
    free_ns = std::max(free_ns, now) + work_ns * part;
    busy += work_ns * part;
    end = std::max(end, free_ns);
  };
  pipe(core.alu_ns, w.alu_ns, alu_busy_);
  pipe(core.sfu_ns, w.sfu_ns, sfu_busy_);
  pipe(core.memory_pipe_ns, w.memory_pipe_ns, memory_pipe_busy_);
  pipe(atomic_free_, w.atomic_ns, atomic_busy_);
  push(end, index, s.phase < s.phases ? Step::fetch : Step::leave);
}

void Machine::fetch(std::uint32_t index, double now) {
  Subgroup& s = subgroups_[index];
  const SubgroupWork& w = s.chunk->work;
  Core& core = cores_[s.core];
  const double part = 1.0 / s.phases;
  core.tex_ns = std::max(core.tex_ns, now) + w.tex_ns * part;
  tex_busy_ += w.tex_ns * part;
  s.ready_ns = s.asks_from_ns = core.tex_ns;
  s.loads = whole(w.storage_lines * part);
  s.textures = 0.0;
  for (double i = whole(w.l1_lines * part); i > 0.0; i -= 1.0)
    if (!core.l1.access(core.reads.next(l1_survival_, false, 1.0, 0.0), false).hit) s.textures += 1.0;
  core.fetching.push_back(index);
  if (core.fetching.size() == 1) ask(core, now);
}

// A core has a limited number of lines on their way. What it cannot ask for yet it asks for when some have
// come: asking ahead of time would take DRAM's place from requests of other units that come before.
void Machine::ask(Core& core, double now) {
  constexpr std::size_t kTogether = 16;
  while (!core.fetching.empty()) {
    const std::uint32_t index = core.fetching.front();
    Subgroup& s = subgroups_[index];
    if (!ask_lines(core, s, now))
      return push(std::max(core.misses.front(), core.misses[kTogether - 1]), index, Step::more);
    ++s.phase;
    push(s.ready_ns + rates_.tex_latency_ns, index, Step::work);
    core.fetching.pop_front();
  }
}

bool Machine::ask_lines(Core& core, Subgroup& s, double now) {
  const double start = std::max(now, s.asks_from_ns);
  while (s.textures > 0.0 || s.loads > 0.0) {
    while (!core.misses.empty() && core.misses.front() <= start) core.misses.pop_front();
    if (core.misses.size() >= core_lines_max_) return false;
    const bool texture = s.textures > 0.0;
    const Stream stream = texture ? Stream::texture : Stream::storage;
    const double arrives =
        memory_.access(MemoryClient::reads, stream, reads_[at(stream)], 1.0, false, false, start);
    core.misses.push_back(arrives);
    s.ready_ns = std::max(s.ready_ns, arrives);
    (texture ? s.textures : s.loads) -= 1.0;
  }
  return true;
}

void Machine::leave(std::uint32_t index, double now) {
  const Leaving out = finish(*subgroups_[index].chunk, now);
  last_ns_ = std::max(last_ns_, out.done_ns);
  events_since_progress_ = 0;
  if (out.accepted_ns > now) return push(out.accepted_ns, index, Step::release);
  release(index);
}

void Machine::release(std::uint32_t index) {
  cores_[subgroups_[index].core].resident -= 1.0;
  idle_.push_back(index);
}

// A subgroup holds its place until the queue to the ROPs has room.
Machine::Leaving Machine::finish(const ChunkPackets& chunk, double now) {
  const std::size_t slot = finished_ % fifo_packets_;
  const double accepted = finished_ >= fifo_packets_ ? std::max(now, leave_done_[slot]) : now;
  ++finished_;
  double start = std::max(accepted, crop_free_);
  const double packets = chunk.leaving_packets;
  start = move(chunk, {Stream::color, Stream::other}, packets, start, color_lines_);
  const double stored = chunk.l2.write[at(Stream::storage)] * packets;
  if (stored > 0.0) start = move_lines(stored, Stream::storage, true, false, start, color_lines_);
  double done = serve(crop_free_, start, chunk.service_ns[at(Unit::crop)] * packets, Unit::crop);
  const double resolve_ns = chunk.service_ns[at(Unit::resolve)] * packets;
  if (resolve_ns > 0.0) done = std::max(done, serve(resolve_free_, start, resolve_ns, Unit::resolve));
  leave_done_[slot] = done;
  return {accepted, done};
}

double Machine::move(const ChunkPackets& chunk, std::initializer_list<Stream> streams, double packets,
                     double now, std::deque<double>& outstanding) {
  for (const Stream stream : streams) {
    const std::size_t i = at(stream);
    now = move_lines(packets * chunk.l2.read[i], stream, false, false, now, outstanding);
    now = move_lines(packets * chunk.l2.write[i], stream, true, false, now, outstanding);
    now = move_lines(packets * chunk.direct.read[i], stream, false, true, now, outstanding);
    now = move_lines(packets * chunk.direct.write[i], stream, true, true, now, outstanding);
  }
  return now;
}

/// When the last of the lines could be asked for: fixed-function units look ahead as far as their buffers go.
double Machine::move_lines(double bytes, Stream stream, bool write, bool bypass, double now,
                           std::deque<double>& outstanding) {
  static constexpr Survival kAlwaysNew = [] {
    Survival all{};
    all.fill(1.0);
    return all;
  }();
  if (bytes <= 0.0) return now;
  const Survival& of_l2 = (write ? writes_ : reads_)[at(stream)];
  const double lines = whole(bytes / kTextureLineBytes);
  const double run_lines = (write ? plan_.run_lines.write : plan_.run_lines.read)[at(stream)];
  for (double i = 0.0; i < lines; i += 1.0) {
    while (!outstanding.empty() && outstanding.front() <= now) outstanding.pop_front();
    if (outstanding.size() >= unit_lines_max_) {
      now = std::max(now, outstanding.front());
      outstanding.pop_front();
    }
    outstanding.push_back(memory_.access(client_of(stream), stream, bypass ? kAlwaysNew : of_l2, run_lines,
                                         write, bypass, now));
  }
  return now;
}

void Machine::push(double ns, std::uint32_t subgroup, Step step) {
  events_.push({ns, event_number_++, subgroup, step});
}

double Machine::whole(double mean) {
  const double low = std::floor(mean);
  return low + (random_.ratio() < mean - low ? 1.0 : 0.0);
}

std::array<double, kUnitCount> Machine::busy_ns() const {
  std::array<double, kUnitCount> busy = busy_ns_;
  const auto cores = static_cast<double>(cores_.size());
  busy[at(Unit::shader)] =
      std::max(std::max({alu_busy_, sfu_busy_, memory_pipe_busy_}) / cores, atomic_busy_);
  busy[at(Unit::tex)] = tex_busy_ / cores;
  busy[at(Unit::l2)] = memory_.l2_busy_ns();
  busy[at(Unit::dram)] = memory_.dram().busy_ns();
  return busy;
}

namespace {

/// What a client asks L2 for, how much of it is far.
struct Asked {
  double lines = 0.0, written = 0.0, far = 0.0;
};

}  // namespace

// Rows, queues and what the cores hold stay as they are.
void Machine::skip_to(std::uint64_t packet) {
  std::array<Asked, kMemoryClients> asked{};
  std::vector<MemorySystem::Passing> passing;
  StreamBytesOf<double> lines;
  double lookups = 0.0;
  const double l1_missing = missing(l1_survival_, static_cast<double>(cores_.front().l1.lines()));
  for (const ChunkPackets& chunk : plan_.chunks) {
    const std::uint64_t from = std::max(next_, chunk.first), to = std::min(packet, chunk.first + chunk.count);
    if (from >= to) continue;
    const auto n = static_cast<double>(to - from);
    for (std::size_t i = 0; i < kStreamCount; ++i) {
      lines.read[i] += n * chunk.l2.read[i] / kTextureLineBytes;
      lines.write[i] += n * chunk.l2.write[i] / kTextureLineBytes;
    }
    const double subgroups = n * chunk.subgroups / static_cast<double>(chunk.count);
    lines.read[at(Stream::storage)] += subgroups * chunk.work.storage_lines;
    lines.read[at(Stream::texture)] += subgroups * chunk.work.l1_lines * l1_missing;
    lookups += subgroups * chunk.work.l1_lines / static_cast<double>(cores_.size());
  }
  const auto pass_by = [&](std::size_t i, bool write, double count) {
    if (count <= 0.0) return;
    const auto stream = static_cast<Stream>(i);
    const Survival& survival = (write ? writes_ : reads_)[i];
    const double far = count * missing(survival, memory_.near_lines());
    Asked& a = asked[static_cast<std::size_t>(client_of(stream))];
    a.lines += count;
    a.written += write ? count : 0.0;
    a.far += far;
    passing.push_back({client_of(stream), &survival,
                       (write ? plan_.run_lines.write : plan_.run_lines.read)[i], far, write, 0.0});
  };
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    pass_by(i, false, lines.read[i]);
    pass_by(i, true, lines.write[i]);
  }
  for (MemorySystem::Passing& p : passing) {  // a line is asked for lines / far times while it is near
    const Asked& a = asked[static_cast<std::size_t>(p.client)];
    if (a.far > 0.0) p.written_ratio = 1.0 - std::pow(1.0 - a.written / a.lines, a.lines / a.far - 1.0);
  }
  memory_.pass_by(passing);
  for (Core& core : cores_) core.pass_by(lookups * missing(l1_survival_, core.l1_has()));
  next_ = packet;
}

void Machine::stall(std::uint64_t packet) const {
  std::string text = "detailed engine: nothing moves in pass \"" + pass_.name + "\" at packet " +
                     std::to_string(packet) + " of " + std::to_string(plan_.packets) + ", " +
                     std::to_string(now_ns_) + " ns; entered " + std::to_string(entered_) + ", finished " +
                     std::to_string(finished_) + "; free at (ns):";
  for (std::size_t u = 0; u < kFrontUnits.size(); ++u)
    text += " " + std::string(unit_name(kFrontUnits[u])) + " " + std::to_string(front_free_[u]);
  text += " crop " + std::to_string(crop_free_) + " l2 " + std::to_string(memory_.l2_free_ns()) + " dram " +
          std::to_string(memory_.dram().free_ns()) + "; resident subgroups of the cores:";
  for (const Core& core : cores_) text += " " + std::to_string(static_cast<int>(core.resident));
  throw StallError(text);
}

}  // namespace hwsim
