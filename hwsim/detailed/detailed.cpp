#include "hwsim/detailed/detailed.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hwsim {
namespace {

constexpr double kMeasuredStays = 2.0;  // a window is so many times as long as packets stay in the mean
constexpr double kWindowsMin = 8.0;     // fewer see too little of a pass to say how much they missed

/// Quantiles of Student's t for a two-sided 90 % interval, by degrees of freedom.
double student_t90(std::size_t degrees) {
  constexpr std::array<double, 10> kSmall = {6.314, 2.920, 2.353, 2.132, 2.015,
                                             1.943, 1.895, 1.860, 1.833, 1.812};
  if (degrees == 0) return kSmall[0];
  if (degrees <= kSmall.size()) return kSmall[degrees - 1];
  return 1.645 + 1.6 / static_cast<double>(degrees);
}

/// A pass along what the closed forms expect of its packets, and along how often they fill the machine.
class Timeline {
 public:
  explicit Timeline(const PacketPlan& plan) : plan_(plan) {
    for (const ChunkPackets& chunk : plan.chunks) {
      before_ns_.push_back(all_ns_);
      all_ns_ += static_cast<double>(chunk.count) * chunk.expected_ns;
    }
  }
  std::uint64_t packets() const { return plan_.packets; }
  double ns_of(std::uint64_t packet) const {
    if (packet >= plan_.packets) return all_ns_;
    const std::size_t k = chunk_of(packet);
    return before_ns_[k] + static_cast<double>(packet - plan_.chunks[k].first) * plan_.chunks[k].expected_ns;
  }
  double bytes_of(std::uint64_t first, std::uint64_t last) const {
    double bytes = 0.0;
    for (const ChunkPackets& chunk : plan_.chunks) {
      const std::uint64_t from = std::max(first, chunk.first), to = std::min(last, chunk.first + chunk.count);
      if (from < to) bytes += static_cast<double>(to - from) * chunk.expected_bytes;
    }
    return bytes;
  }
  std::uint64_t packet_at(double ns) const {
    const auto after = std::upper_bound(before_ns_.begin() + 1, before_ns_.end(), ns);
    const auto k = static_cast<std::size_t>(after - before_ns_.begin()) - 1;
    const ChunkPackets& chunk = plan_.chunks[k];
    if (chunk.expected_ns <= 0.0) return chunk.first;
    const double inside = std::max(0.0, ns - before_ns_[k]) / chunk.expected_ns;
    return chunk.first + std::min(chunk.count, static_cast<std::uint64_t>(inside));
  }
  /// The packet behind those that fill the machine, from `packet` on.
  std::uint64_t after_fill(std::uint64_t packet) const {
    double fills = 1.0;
    for (std::size_t k = chunk_of(packet); k < plan_.chunks.size(); ++k) {
      const ChunkPackets& chunk = plan_.chunks[k];
      const auto rest = static_cast<double>(chunk.first + chunk.count - packet);
      if (fills * chunk.in_flight < rest) return packet + static_cast<std::uint64_t>(fills * chunk.in_flight);
      fills -= rest / chunk.in_flight;
      packet = chunk.first + chunk.count;
    }
    return plan_.packets;
  }
  /// The first of those that fill it, up to `packet`.
  std::uint64_t before_fill(std::uint64_t packet) const {
    double fills = 1.0;
    for (std::size_t k = chunk_of(packet - 1) + 1; k-- > 0;) {
      const ChunkPackets& chunk = plan_.chunks[k];
      const auto rest = static_cast<double>(packet - chunk.first);
      if (fills * chunk.in_flight < rest) return packet - static_cast<std::uint64_t>(fills * chunk.in_flight);
      fills -= rest / chunk.in_flight;
      packet = chunk.first;
    }
    return 0;
  }
  /// How long what is in flight at a packet stays.
  double stay_ns(std::uint64_t packet) const {
    const ChunkPackets& chunk = plan_.chunks[chunk_of(std::min(packet, plan_.packets - 1))];
    return chunk.in_flight * chunk.expected_ns;
  }
  double mean_stay_ns() const {
    double sum = 0.0;
    for (const ChunkPackets& chunk : plan_.chunks)
      sum += static_cast<double>(chunk.count) * chunk.expected_ns * chunk.in_flight * chunk.expected_ns;
    return all_ns_ > 0.0 ? sum / all_ns_ : 0.0;
  }

 private:
  std::size_t chunk_of(std::uint64_t packet) const {
    return static_cast<std::size_t>(&plan_.chunk_of(packet) - plan_.chunks.data());
  }
  const PacketPlan& plan_;
  std::vector<double> before_ns_;
  double all_ns_ = 0.0;
};

void add(Machine::Progress& sum, const Machine::Progress& from, const Machine::Progress& to, double times,
         double bytes_times) {
  sum.ns += times * (to.ns - from.ns);
  for (std::size_t u = 0; u < kUnitCount; ++u) sum.busy_ns[u] += times * (to.busy_ns[u] - from.busy_ns[u]);
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    sum.bytes.read[i] += bytes_times * (to.bytes.read[i] - from.bytes.read[i]);
    sum.bytes.write[i] += bytes_times * (to.bytes.write[i] - from.bytes.write[i]);
  }
}

/// Where a pass is simulated: the packets up to `head`, which fill the machine, and those from `tail` on,
/// with which it empties, are measured as they are. What lies between is cut into equal parts of the expected
/// time, and a window of each, at a random place, is measured (SMARTS, Wunderlich et al., ISCA 2003, with
/// strata): every moment has the same chance, so the mean of the windows' ratios is that of the pass. The
/// machine does not run empty between windows, packets before each displace what is left of the last one,
/// and caches go on as if all packets had come.
struct Windows {
  std::uint64_t head = 0, tail = 0;
  double count = 0.0, expected_ns = 0.0;
};

Windows plan_windows(const Timeline& line, double ratio) {
  Windows w;
  const double all_ns = line.ns_of(line.packets());
  if (ratio >= 1.0 || all_ns <= 0.0) return w;
  w.head = line.after_fill(0);
  w.tail = line.before_fill(line.packets());
  const double head_ns = line.ns_of(w.head), tail_ns = line.ns_of(w.tail);
  w.expected_ns = kMeasuredStays * line.mean_stay_ns();
  const double with_warming_ns = w.expected_ns * (1.0 + 1.0 / kMeasuredStays),
               ends_ns = head_ns + 2.0 * (all_ns - tail_ns);
  w.count = std::max(kWindowsMin, std::floor((ratio * all_ns - ends_ns) / with_warming_ns));
  constexpr double kWorthwhile = 0.8;  // part of the pass; beyond it, all of it is simulated
  if (w.count * with_warming_ns + ends_ns > kWorthwhile * all_ns) w.count = 0.0;
  return w;
}

/// Takes equally probable places, each with the ratio of the time there to what was expected.
struct MeanRatio {
  std::vector<double> ratios;
  double value() const {
    return std::accumulate(ratios.begin(), ratios.end(), 0.0) / static_cast<double>(ratios.size());
  }
  double half_interval() const {
    const auto n = static_cast<double>(ratios.size());
    double squares = 0.0;
    for (const double ratio : ratios) squares += (ratio - value()) * (ratio - value());
    return student_t90(ratios.size() - 1) * std::sqrt(squares / (n - 1.0) / n);
  }
};

Machine::Progress run_windows(Machine& machine, const Timeline& line, const Windows& w, Random& random,
                              DetailedTime& result) {
  Machine::Progress sum = machine.enter_until(w.head), windows;
  result.simulated_packets = w.head;
  const double from_ns = line.ns_of(w.head), all_ns = line.ns_of(w.tail) - from_ns;
  MeanRatio ratio;
  double simulated_ns = 0.0, simulated_bytes = 0.0;
  std::uint64_t last = w.head;
  const double part_ns = all_ns / w.count;
  for (double i = 0.0; i < w.count; i += 1.0) {
    const double place_ns = from_ns + i * part_ns + random.ratio() * (part_ns - w.expected_ns);
    const std::uint64_t measured = line.packet_at(place_ns),
                        warming = std::min(line.before_fill(measured),
                                           line.packet_at(place_ns - line.stay_ns(last)));
    machine.skip_to(std::max(last, warming));
    result.simulated_packets += line.packet_at(place_ns + w.expected_ns) - std::max(last, warming);
    last = line.packet_at(place_ns + w.expected_ns);
    const Machine::Progress before = machine.enter_until(measured), after = machine.enter_until(last);
    const double expected_ns = line.ns_of(last) - line.ns_of(measured);
    if (expected_ns <= 0.0) continue;
    ratio.ratios.push_back((after.ns - before.ns) / expected_ns);
    simulated_ns += expected_ns;
    simulated_bytes += line.bytes_of(measured, last);
    add(windows, before, after, 1.0, 1.0);
  }
  const auto times = [](double whole, double part) { return part > 0.0 ? whole / part : 1.0; };
  Machine::Progress middle;
  add(middle, {}, windows, times(all_ns, simulated_ns),
      times(line.bytes_of(w.head, w.tail), simulated_bytes));
  middle.ns = ratio.value() * all_ns;
  add(sum, {}, middle, 1.0, 1.0);
  machine.skip_to(std::max(last, line.before_fill(w.tail)));
  const Machine::Progress before = machine.enter_until(w.tail);
  machine.enter_until(line.packets());
  add(sum, before, machine.drain(), 1.0, 1.0);
  result.simulated_packets += 2 * (line.packets() - w.tail);
  const double half = ratio.half_interval() * all_ns;
  result.interval_ns = {std::max(0.0, sum.ns - half), sum.ns + half};
  return sum;
}

/// The stack of an engine without a critical path: units in proportion to a high power of their busy time.
void share_stack(PassTime<double>& time) {
  constexpr double kSharpness = 8.0;
  const PowerShares<double> shares(time.busy_ns, kSharpness);
  if (shares.peak > 0.0)
    shares.share(time);
  else
    time.stack_ns[index_of(Unit::fe)] = time.time_ns;
}

}  // namespace

DetailedTime detailed_time(const PassWork& pass, const GpuConfig& gpu, const GpuRates<double>& rates,
                           const TimingOptions& options, std::uint64_t seed) {
  DetailedTime result;
  const PacketPlan plan = plan_packets(pass, rates);
  result.packets = plan.packets;
  if (plan.packets == 0) return result;
  Machine machine(pass, plan, gpu, rates, options.events_without_progress_max, seed);
  const Timeline line(plan);
  const Windows windows = plan_windows(line, options.detailed_sample_ratio);
  Random random(seed + 17);
  Machine::Progress end;
  if (windows.count == 0.0) {
    machine.enter_until(plan.packets);
    end = machine.drain();
    result.simulated_packets = plan.packets;
  } else {
    end = run_windows(machine, line, windows, random, result);
  }
  end.busy_ns[index_of(Unit::dram)] +=
      machine.memory().flush_ns();  // once, however much of the pass was simulated
  result.time.dram = end.bytes;
  result.time.dram += machine.memory().flush_bytes();
  result.time.time_ns = std::max(
      {end.ns, end.busy_ns[index_of(Unit::dram)], result.time.dram.total() / gpu.dram_bandwidth_gb_s});
  for (std::size_t u = 0; u < kUnitCount; ++u)
    result.time.busy_ns[u] = std::min(end.busy_ns[u], result.time.time_ns);
  share_stack(result.time);
  return result;
}

}  // namespace hwsim
