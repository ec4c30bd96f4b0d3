#include "hwsim/detailed/memory.h"

#include <algorithm>

#include "hwsim/base/units_of_measure.h"

namespace hwsim {
namespace {

constexpr std::size_t kLinesMax = 4u << 20;  // 256 MiB: larger caches are as good as this one

constexpr int kClientShift = 40;
Stream owner(std::uint64_t line) {
  switch (static_cast<MemoryClient>(line >> kClientShift)) {
    case MemoryClient::color:
      return Stream::color;
    case MemoryClient::depth:
      return Stream::depth;
    case MemoryClient::reads:
      return Stream::storage;
    default:
      return Stream::other;
  }
}

std::size_t l2_lines(const GpuConfig& gpu) {
  const double lines = (gpu.l2_size_kib + gpu.llc_size_kib) * kBytesPerKib / kTextureLineBytes;
  return std::min(kLinesMax, static_cast<std::size_t>(std::max(16.0, lines)));
}

}  // namespace

LineCache::LineCache(std::size_t lines, std::size_t ways)
    : sets_(std::max<std::size_t>(1, lines / ways)),
      ways_(std::min(ways, std::max<std::size_t>(1, lines))),
      tags_(sets_ * ways_, 0) {}

LineCache::Outcome LineCache::access(std::uint64_t line, bool write) {
  const std::uint64_t mixed = (line ^ line >> 7 ^ line >> 14) * 0x9e3779b97f4a7c15ull;
  const auto first = tags_.begin() + static_cast<std::ptrdiff_t>((mixed >> 20) % sets_ * ways_);
  const auto last = first + static_cast<std::ptrdiff_t>(ways_);
  auto found = std::find_if(first, last, [line](std::uint64_t tag) { return tag >> 1 == line + 1; });
  Outcome outcome;
  outcome.hit = found != last;
  if (!outcome.hit) {
    found = last - 1;
    outcome.writes_back = (*found & 1) != 0;
    outcome.left_line = (*found >> 1) - 1;
    dirty_ -= outcome.writes_back ? 1 : 0;
    *found = (line + 1) << 1;
  }
  if (write && (*found & 1) == 0) {
    *found |= 1;
    ++dirty_;
  }
  std::rotate(first, found, found + 1);
  return outcome;
}

MemorySystem::MemorySystem(const GpuConfig& gpu, std::uint64_t seed)
    : l2_(l2_lines(gpu), static_cast<std::size_t>(gpu.l2_ways)), dram_(gpu), random_(seed + 50) {
  const double clk_ns = kNsPerUs / gpu.core_clock_mhz;
  l2_line_ns_ = kTextureLineBytes * clk_ns / gpu.l2_bytes_per_clk;
  // Latencies are those seen by a texture request; that of L1 is part of them.
  l2_latency_ns_ = std::max(0.0, (gpu.l2_latency_cycles - gpu.tex_latency_cycles) * clk_ns);
  for (std::size_t i = 0; i < kMemoryClients; ++i)
    sources_[i] = std::make_unique<AddressSource>(static_cast<std::uint64_t>(i) << kClientShift,
                                                  2 * l2_.lines(), seed + i);
}

double MemorySystem::access(MemoryClient client, Stream stream, const Survival& survival, double run_lines,
                            bool write, bool bypass, double now_ns) {
  const std::uint64_t line =
      sources_[static_cast<std::size_t>(client)]->next(survival, write, run_lines, 0.0);
  const auto move = [this](Stream of, bool out) {
    (out ? bytes_.write : bytes_.read)[index_of(of)] += kTextureLineBytes;
  };
  if (bypass) {
    move(stream, write);
    return dram_.access(line, write, now_ns);
  }
  l2_busy_ns_ += l2_line_ns_;
  double at_l2 = l2_calendar_.reserve(now_ns, l2_line_ns_) + l2_latency_ns_;
  const LineCache::Outcome outcome = l2_.access(line, write);
  if (outcome.writes_back) {
    move(owner(outcome.left_line), true);
    at_l2 = dram_.access(outcome.left_line, true, at_l2);  // its place is free when the write is taken over
  }
  if (outcome.hit || write) return at_l2;  // what is written need not be read first: sectors are valid alone
  move(stream, false);
  return dram_.access(line, false, at_l2);
}

// Order within what the banks' queues put in order again does not matter, nor do lines that L2 still has.
double MemorySystem::near_lines() const {
  return std::min(dram_.reordered_lines(), static_cast<double>(l2_.lines()) / 4.0);
}

// Only the last remain to be seen of more than what fills L2 twice. All in turn.
void MemorySystem::pass_by(const std::vector<Passing>& accesses) {
  double all = 0.0;
  for (const Passing& p : accesses) all += p.far_accesses;
  const double made = std::min(all, 2.0 * static_cast<double>(l2_.lines()));
  if (made < 1.0) return;
  std::vector<double> due(accesses.size(), 0.0);
  for (double i = 1.0; i <= made; i += 1.0)
    for (std::size_t k = 0; k < accesses.size(); ++k) {
      const Passing& p = accesses[k];
      due[k] += p.far_accesses / all;
      if (due[k] < 1.0) continue;
      due[k] -= 1.0;
      AddressSource& source = *sources_[static_cast<std::size_t>(p.client)];
      const std::uint64_t line = source.next(*p.survival, p.write, p.run_lines, near_lines());
      l2_.access(line, p.write || random_.ratio() < p.written_ratio);
    }
}

StreamBytesOf<double> MemorySystem::flush_bytes() const {
  StreamBytesOf<double> bytes;
  l2_.each_dirty_line([&](std::uint64_t line) { bytes.write[index_of(owner(line))] += kTextureLineBytes; });
  return bytes;
}

double MemorySystem::flush_ns() const {
  return static_cast<double>(l2_.dirty_lines()) * dram_.line_ns() / dram_.channel_count();
}

}  // namespace hwsim
