#pragma once
// DRAM: peak, what is reached of it, turns of the bus; channels, banks and rows for the detailed engine.
#include "hwsim/config/key.h"
#include "hwsim/units/ranges.h"
#include "hwsim/units/unit_work.h"

namespace hwsim::units {

/// DRAM.
struct Dram {
  static constexpr UnitInfo kInfo = {
      "dram", UnitPlace::memory, set_of(),
      "bytes / (`dram_bandwidth_gb_s` x `dram_efficiency_ratio` x (1 - `dram_cpu_share_ratio`)) + two turns "
      "of the bus (`dram_turn_ns` / `dram_channels`) for each `dram_write_lines` lines written, where there "
      "are reads between them"};

  template <class T>
  struct Values {
    T dram_bandwidth_gb_s{0.0};
    T dram_efficiency_ratio{0.8};
    T dram_cpu_share_ratio{0.0};
    T dram_latency_cycles{400.0};
    int dram_channels = 4;
    int dram_banks = 16;
    int dram_interleave_bytes = 256;
    int dram_queue_rows = 4;
    int dram_write_lines = 32;
    int dram_write_groups = 2;
    T dram_row_bytes{2048.0};
    T dram_row_miss_ns{26.0};
    T dram_row_cycle_ns{43.0};
    T dram_turn_ns{8.0};
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key({"dram_bandwidth_gb_s", kRateLow, 1e5, kRequired | kFit | kFaster, "peak, 1e9 bytes a second"},
          c.dram_bandwidth_gb_s);
    v.key({"dram_efficiency_ratio", kRatioLow, 1, kFit | kFaster, "of the peak, reached"},
          c.dram_efficiency_ratio);
    v.key({"dram_cpu_share_ratio", 0, 0.95, kFit | kSlower, "of what is reached, taken by the CPU"},
          c.dram_cpu_share_ratio);
    v.key({"dram_latency_cycles", 0, 1e5, kSlower, "core clocks of a read from DRAM, unloaded"},
          c.dram_latency_cycles);
    v.key({"dram_channels", 1, 256, kNeither, "independent channels, which share the turns of the bus"},
          c.dram_channels);
    v.key({"dram_banks", 1, 256, kFaster, "engine detailed: banks of a channel"}, c.dram_banks);
    v.key({"dram_interleave_bytes", 64, 65536, kNeither,
           "engine detailed: neighboring bytes that go to one channel, in whole lines"},
          c.dram_interleave_bytes);
    v.key({"dram_queue_rows", 1, 64, kFaster,
           "engine detailed: rows of a bank whose requests the controller serves together"},
          c.dram_queue_rows);
    v.key({"dram_write_lines", 1, 4096, kFaster, "lines that a channel writes together, between two turns"},
          c.dram_write_lines);
    v.key({"dram_write_groups", 1, 64, kFaster, "engine detailed: such groups that a channel has room for"},
          c.dram_write_groups);
    v.key({"dram_row_bytes", 64, 1e6, kNeither, "engine detailed: an open row of a bank"}, c.dram_row_bytes);
    v.key({"dram_row_miss_ns", 0, 1e4, kNeither, "engine detailed: closing a row and opening another"},
          c.dram_row_miss_ns);
    v.key({"dram_row_cycle_ns", 0, 1e4, kSlower, "engine detailed: from one opening to the next, a bank"},
          c.dram_row_cycle_ns);
    v.key({"dram_turn_ns", 0, 1e4, kSlower, "a channel changes between reads and writes"}, c.dram_turn_ns);
  }

  template <class T>
  struct Rates {
    T dram_byte_ns, dram_turn_ns, dram_latency_ns;
    int dram_write_lines;  ///< that a channel writes together
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    r.dram_byte_ns = 1.0 / (c.dram_bandwidth_gb_s * c.dram_efficiency_ratio * (1.0 - c.dram_cpu_share_ratio));
    r.dram_turn_ns = T(c.dram_turn_ns) / static_cast<double>(c.dram_channels);
    r.dram_latency_ns = c.dram_latency_cycles * clk_ns;
    r.dram_write_lines = c.dram_write_lines;
  }

  template <class T, class R>
  static T service_ns(const UnitWork<T>& w, const R& r) {
    const StreamBytesOf<T>& bytes = w.traffic.dram;
    T read(0.0), write(0.0);
    for (const T& b : bytes.read) read += b;
    for (const T& b : bytes.write) write += b;
    const T groups = smaller(T(write / static_cast<double>(r.dram_write_lines)), read) / kTextureLineBytes;
    return (read + write) * r.dram_byte_ns + 2.0 * groups * r.dram_turn_ns;
  }
};

}  // namespace hwsim::units
