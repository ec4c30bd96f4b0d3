#include "hwsim/timing/detailed/detailed.h"

#include <algorithm>
#include <cmath>

namespace hwsim {
namespace {

constexpr double kFillsPerWindow = 3.0;  // a window is so many times what the cores hold at once

/// Quantiles of Student's t for a two-sided 90 % interval, by degrees of freedom.
double student_t90(std::size_t degrees) {
  constexpr std::array<double, 10> kSmall = {6.314, 2.920, 2.353, 2.132, 2.015,
                                             1.943, 1.895, 1.860, 1.833, 1.812};
  if (degrees == 0) return kSmall[0];
  if (degrees <= kSmall.size()) return kSmall[degrees - 1];
  return 1.645 + 1.6 / static_cast<double>(degrees);
}

double held_at_once(const PacketPlan& plan, const GpuRates<double>& rates) {
  double most = 64.0;  // the front's queues
  for (const ChunkPackets& chunk : plan.chunks)
    if (chunk.subgroups > 0.0) most = std::max(most, chunk.resident * rates.shader_cores);
  return most;
}

/// One run of consecutive packets in each of several strata of equal length; before and after it, packets
/// that fill the machine and are not measured (SMARTS, Wunderlich et al., ISCA 2003, with strata).
struct Windows {
  std::uint64_t count = 0, length = 0, margin = 0;
};

Windows plan_windows(const PacketPlan& plan, const GpuRates<double>& rates, double ratio) {
  const double held = held_at_once(plan, rates);
  Windows w;
  w.margin = static_cast<std::uint64_t>(held);
  w.length = static_cast<std::uint64_t>(kFillsPerWindow * held);
  const double run_packets = static_cast<double>(w.length + 2 * w.margin);
  w.count = static_cast<std::uint64_t>(ratio * static_cast<double>(plan.packets) / run_packets);
  if (ratio >= 1.0) w.count = 0;
  w.count = std::max<std::uint64_t>(w.count, ratio < 1.0 ? 3 : 0);
  if (static_cast<double>(w.count) * run_packets > 0.8 * static_cast<double>(plan.packets)) w.count = 0;
  return w;
}

void run_whole(Machine& machine, const PacketPlan& plan, DetailedTime& result) {
  machine.run(0, plan.packets);
  result.simulated_packets = plan.packets;
  result.time.time_ns = machine.end_ns();
}

void run_windows(Machine& machine, const PacketPlan& plan, const Windows& w, Random& random,
                 DetailedTime& result) {
  const double stratum = static_cast<double>(plan.packets) / static_cast<double>(w.count);
  const double slack = stratum - static_cast<double>(w.length + 2 * w.margin);
  double sum = 0.0, squares = 0.0;
  for (std::uint64_t i = 0; i < w.count; ++i) {
    const auto first =
        static_cast<std::uint64_t>(static_cast<double>(i) * stratum + random.ratio() * std::max(0.0, slack));
    const std::uint64_t last = std::min(plan.packets, first + w.length + 2 * w.margin);
    if (i > 0) machine.warm_up();
    const std::vector<double> done = machine.run(first, last);
    const auto from = static_cast<std::size_t>(w.margin),
               to = done.size() - static_cast<std::size_t>(w.margin);
    const double rate = (done[to - 1] - done[from - 1]) / static_cast<double>(to - from);
    sum += rate;
    squares += rate * rate;
    result.simulated_packets += last - first;
  }
  const auto n = static_cast<double>(w.count);
  const double mean = sum / n, variance = std::max(0.0, (squares - n * mean * mean) / (n - 1.0));
  const double half = student_t90(w.count - 1) * std::sqrt(variance / n) * static_cast<double>(plan.packets);
  result.time.time_ns = mean * static_cast<double>(plan.packets);
  result.interval_ns = {std::max(0.0, result.time.time_ns - half), result.time.time_ns + half};
}

/// The stack of an engine without a critical path: units in proportion to a high power of their busy time.
void share_stack(PassTime<double>& time) {
  constexpr double kSharpness = 8.0;
  double peak = 0.0, sum = 0.0;
  for (const double busy : time.busy_ns) peak = std::max(peak, busy);
  if (peak <= 0.0) {
    time.stack_ns[at(Unit::fe)] = time.time_ns;
    return;
  }
  for (const double busy : time.busy_ns) sum += std::pow(busy / peak, kSharpness);
  for (std::size_t u = 0; u < kUnitCount; ++u)
    time.stack_ns[u] = time.time_ns * std::pow(time.busy_ns[u] / peak, kSharpness) / sum;
}

}  // namespace

DetailedTime detailed_time(const PassWork& pass, const GpuConfig& gpu, const GpuRates<double>& rates,
                           const TimingOptions& options, std::uint64_t seed) {
  DetailedTime result;
  const PacketPlan plan = plan_packets(pass, rates);
  result.packets = plan.packets;
  if (plan.packets == 0) return result;
  Machine machine(pass, plan, gpu, rates, options.events_without_progress_max, seed);
  const Windows windows = plan_windows(plan, rates, options.detailed_sample_ratio);
  Random random(seed + 17);
  if (windows.count == 0)
    run_whole(machine, plan, result);
  else
    run_windows(machine, plan, windows, random, result);
  const double scale = static_cast<double>(plan.packets) / static_cast<double>(result.simulated_packets);
  result.time.dram = machine.dram_bytes();
  const std::array<double, kUnitCount> busy = machine.busy_ns();
  for (std::size_t u = 0; u < kUnitCount; ++u)
    result.time.busy_ns[u] = std::min(busy[u] * scale, result.time.time_ns);
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    result.time.dram.read[i] *= scale;
    result.time.dram.write[i] *= scale;
  }
  result.time.dram += machine.memory().flush_bytes();  // once, however much of the pass was simulated
  result.time.time_ns = std::max(result.time.time_ns, result.time.dram.total() / gpu.dram_bandwidth_gb_s);
  share_stack(result.time);
  return result;
}

}  // namespace hwsim
