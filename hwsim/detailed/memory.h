#pragma once
// L2 and what lies behind it, as the units of the detailed engine see it: lines requested, times returned.
#include <array>
#include <memory>

#include "hwsim/detailed/address_source.h"
#include "hwsim/detailed/dram.h"
#include "hwsim/timing/traffic.h"

namespace hwsim {

/// Lines of 64 bytes in sets, with write-back.
class LineCache {
 public:
  LineCache(std::size_t lines, std::size_t ways);
  struct Outcome {
    bool hit = false;
    bool writes_back = false;  ///< a line that was written had to leave
    std::uint64_t left_line = 0;
  };
  Outcome access(std::uint64_t line, bool write);
  std::size_t dirty_lines() const { return dirty_; }
  template <class Visit>
  void each_dirty_line(const Visit& visit) const {
    for (const std::uint64_t tag : tags_)
      if ((tag & 1) != 0) visit((tag >> 1) - 1);
  }
  std::size_t lines() const { return sets_ * ways_; }

 private:
  std::size_t sets_, ways_, dirty_ = 0;
  std::vector<std::uint64_t> tags_;  ///< (line + 1) * 2 + dirty, latest first in a set; 0: empty
};

/// Who asks: each has addresses of its own.
enum class MemoryClient : unsigned char { reads, color, depth, other };
inline constexpr std::size_t kMemoryClients = 4;

class MemorySystem {
 public:
  MemorySystem(const GpuConfig& gpu, std::uint64_t seed);

  /// A line of a stream through L2, or (`bypass`) straight to DRAM; returns when it is there.
  double access(MemoryClient client, Stream stream, const Survival& survival, double run_lines, bool write,
                bool bypass, double now_ns);
  /// Accesses to L2 while nothing is simulated, by their distances: those that find their line within
  /// `near_lines()` change nothing that matters and are left out.
  struct Passing {
    MemoryClient client;
    const Survival* survival;
    double run_lines, far_accesses;
    bool write;
    double written_ratio;  ///< part of the reads whose line is written soon after, by an access that was left
                           ///< out
  };
  double near_lines() const;
  /// L2 and the clients' memory of their lines after these; nothing is moved, no time passes.
  void pass_by(const std::vector<Passing>& accesses);
  const AddressSource& source(MemoryClient client) const {
    return *sources_[static_cast<std::size_t>(client)];
  }
  const LineCache& l2() const { return l2_; }
  /// Writes that are still in L2, as time of all channels.
  double flush_ns() const;
  const Dram& dram() const { return dram_; }
  const StreamBytesOf<double>& dram_bytes() const { return bytes_; }
  /// What writing them moves.
  StreamBytesOf<double> flush_bytes() const;
  double l2_busy_ns() const { return l2_busy_ns_; }
  double l2_free_ns() const { return l2_calendar_.last_ns(); }

 private:
  double l2_line_ns_, l2_latency_ns_;
  double l2_busy_ns_ = 0.0;
  Calendar l2_calendar_{64.0};
  LineCache l2_;
  Dram dram_;
  std::array<std::unique_ptr<AddressSource>, kMemoryClients> sources_;
  StreamBytesOf<double> bytes_;
  Random random_;
};

}  // namespace hwsim
