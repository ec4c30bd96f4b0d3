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

/// Packets: those without a subgroup pass between the others.
double held_at_once(const PacketPlan& plan, const GpuRates<double>& rates) {
  double most = 64.0;  // the front's queues
  for (const ChunkPackets& chunk : plan.chunks)
    if (chunk.subgroups > 0.0)
      most = std::max(
          most, chunk.resident * rates.shader_cores * static_cast<double>(chunk.count) / chunk.subgroups);
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

/// What the closed forms expect of packets [first, last).
struct Expected {
  double ns = 0.0, bytes = 0.0;
};
Expected expected_of(const PacketPlan& plan, std::uint64_t first, std::uint64_t last) {
  Expected sum;
  for (const ChunkPackets& chunk : plan.chunks) {
    const std::uint64_t from = std::max(first, chunk.first), to = std::min(last, chunk.first + chunk.count);
    if (from >= to) continue;
    sum.ns += static_cast<double>(to - from) * chunk.expected_ns;
    sum.bytes += static_cast<double>(to - from) * chunk.expected_bytes;
  }
  return sum;
}

/// Measured time of windows over what was expected of them, times what is expected of the pass: a ratio
/// estimate, which chunks of very different cost do not upset.
void estimate(const std::vector<double>& measured, const std::vector<double>& expected, double all_ns,
              DetailedTime& result) {
  const auto n = static_cast<double>(measured.size());
  double sum = 0.0, weight = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    sum += measured[i];
    weight += expected[i];
  }
  const double ratio = weight > 0.0 ? sum / weight : 1.0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const double residual = measured[i] - ratio * expected[i];
    squares += residual * residual;
  }
  const double deviation = weight > 0.0 ? std::sqrt(n * squares / (n - 1.0)) / weight : 0.0;
  constexpr double kEdgeRatio = 0.05;  // subgroups that the edges of windows cut: up to 4 % were seen
  const double half =
      std::hypot(student_t90(measured.size() - 1) * deviation * all_ns, kEdgeRatio * ratio * all_ns);
  result.time.time_ns = ratio * all_ns;
  result.interval_ns = {std::max(0.0, result.time.time_ns - half), result.time.time_ns + half};
}

/// Returns what was expected of all simulated packets.
Expected run_windows(Machine& machine, const PacketPlan& plan, const Windows& w, Random& random,
                     DetailedTime& result) {
  const double stratum = static_cast<double>(plan.packets) / static_cast<double>(w.count);
  const double slack = stratum - static_cast<double>(w.length + 2 * w.margin);
  std::vector<double> measured, expected;
  Expected simulated;
  for (std::uint64_t i = 0; i < w.count; ++i) {
    const auto first =
        static_cast<std::uint64_t>(static_cast<double>(i) * stratum + random.ratio() * std::max(0.0, slack));
    const std::uint64_t last = std::min(plan.packets, first + w.length + 2 * w.margin);
    if (i > 0) machine.warm_up();
    const std::vector<double> done = machine.run(first, last);
    const auto from = static_cast<std::size_t>(w.margin),
               to = done.size() - static_cast<std::size_t>(w.margin);
    measured.push_back(done[to - 1] - done[from - 1]);
    expected.push_back(expected_of(plan, first + from, first + to).ns);
    const Expected all = expected_of(plan, first, last);
    simulated.ns += all.ns;
    simulated.bytes += all.bytes;
    result.simulated_packets += last - first;
  }
  estimate(measured, expected, expected_of(plan, 0, plan.packets).ns, result);
  return simulated;
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
  const Expected all = expected_of(plan, 0, plan.packets);
  Expected simulated = all;
  if (windows.count == 0)
    run_whole(machine, plan, result);
  else
    simulated = run_windows(machine, plan, windows, random, result);
  const double time_scale = simulated.ns > 0.0 ? all.ns / simulated.ns : 1.0,
               byte_scale = simulated.bytes > 0.0 ? all.bytes / simulated.bytes : 1.0;
  result.time.dram = machine.dram_bytes();
  const std::array<double, kUnitCount> busy = machine.busy_ns();
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    result.time.dram.read[i] *= byte_scale;
    result.time.dram.write[i] *= byte_scale;
  }
  result.time.dram += machine.memory().flush_bytes();  // once, however much of the pass was simulated
  result.time.time_ns = std::max(result.time.time_ns, result.time.dram.total() / gpu.dram_bandwidth_gb_s);
  for (std::size_t u = 0; u < kUnitCount; ++u)
    result.time.busy_ns[u] = std::min(busy[u] * time_scale, result.time.time_ns);
  share_stack(result.time);
  return result;
}

}  // namespace hwsim
