#include "hwsim/detailed/dram.h"

#include <algorithm>
#include <numeric>

#include "hwsim/base/units_of_measure.h"

namespace hwsim {
namespace {

constexpr double kLineBytes = 64.0;

}  // namespace

Dram::Dram(const GpuConfig& gpu)
    : interleave_lines_(static_cast<std::uint64_t>(gpu.dram_interleave_bytes) /
                        static_cast<std::uint64_t>(kLineBytes)),
      write_lines_(static_cast<std::size_t>(gpu.dram_write_lines)) {
  const double channels = gpu.dram_channels;
  // The efficiency is what long reads in order reach: refresh, gaps between bank groups and the like. Rows
  // and turns of the bus come on top.
  line_ns_ = kLineBytes * channels /
             (gpu.dram_bandwidth_gb_s * gpu.dram_efficiency_ratio * (1.0 - gpu.dram_cpu_share_ratio));
  row_miss_ns_ = gpu.dram_row_miss_ns;
  row_cycle_ns_ = gpu.dram_row_cycle_ns;
  turn_ns_ = gpu.dram_turn_ns;
  const double clk_ns = kNsPerUs / gpu.core_clock_mhz;
  // The config's latency is that of an idle DRAM with the row closed.
  latency_ns_ =
      std::max(0.0, (gpu.dram_latency_cycles - gpu.l2_latency_cycles) * clk_ns - row_miss_ns_ - line_ns_);
  write_room_ns_ = static_cast<double>(gpu.dram_write_groups) * static_cast<double>(write_lines_) * line_ns_ +
                   row_miss_ns_;
  lines_a_row_ = static_cast<std::uint64_t>(std::max(1.0, gpu.dram_row_bytes / kLineBytes));
  channels_.resize(static_cast<std::size_t>(channels));
  for (Channel& channel : channels_)
    channel.banks.assign(static_cast<std::size_t>(gpu.dram_banks), Bank(gpu.dram_queue_rows));
}

void Dram::turn(Channel& channel, bool writing, double now_ns) {
  if (channel.writing == writing) return;
  channel.writing = writing;
  channel.bus.reserve(now_ns, turn_ns_);
  channel.busy_ns += turn_ns_;
}

// The controller reorders: a line that waits for its bank lets others pass, so the bus stays busy as long as
// any bank is ready, and a bank that is asked for too many rows falls behind by itself.
double Dram::transfer(Channel& channel, std::uint64_t line, double now_ns) {
  const std::uint64_t row = line / lines_a_row_;
  Bank& bank = channel.banks[(row ^ row / channel.banks.size()) % channel.banks.size()];
  double ready = std::max(now_ns, std::min(bank.ready_ns, now_ns + row_miss_ns_));
  if (std::find(bank.rows.begin(), bank.rows.end(), row) == bank.rows.end()) {
    ++row_misses_;
    bank.rows[bank.oldest++ % bank.rows.size()] = row;
    ready = bank.activations.reserve(now_ns, row_cycle_ns_) - row_cycle_ns_ + row_miss_ns_;
    bank.ready_ns = ready;
  }
  channel.busy_ns += line_ns_;
  return channel.bus.reserve(ready, line_ns_);
}

double Dram::access(std::uint64_t line, bool write, double now_ns) {
  const std::uint64_t group = line / interleave_lines_;
  Channel& channel = channels_[group % channels_.size()];
  const std::uint64_t inside = group / channels_.size() * interleave_lines_ + line % interleave_lines_;
  if (!write) {
    turn(channel, false, now_ns);
    return transfer(channel, inside, now_ns) + latency_ns_;
  }
  channel.writes.push_back(inside);
  if (channel.writes.size() < write_lines_) return now_ns;
  turn(channel, true, now_ns);
  std::sort(channel.writes.begin(), channel.writes.end());
  double done = now_ns;
  for (const std::uint64_t waiting : channel.writes) done = transfer(channel, waiting, now_ns);
  channel.writes.clear();
  return std::max(now_ns, done - write_room_ns_);
}

double Dram::busy_ns() const {
  double sum = 0.0;
  for (const Channel& channel : channels_)
    sum += channel.busy_ns + static_cast<double>(channel.writes.size()) * line_ns_;
  return sum / static_cast<double>(channels_.size());
}

double Dram::reordered_lines() const {
  const Channel& channel = channels_.front();
  return static_cast<double>(channels_.size() * channel.banks.size() * channel.banks.front().rows.size() *
                             lines_a_row_);
}

double Dram::free_ns() const {
  double last = 0.0;
  for (const Channel& channel : channels_)
    last = std::max(last, channel.bus.last_ns() + static_cast<double>(channel.writes.size()) * line_ns_);
  return last;
}

}  // namespace hwsim
