#pragma once
// L2, the last-level cache behind it, and the ways of other units to it.
#include "hwsim/base/units_of_measure.h"
#include "hwsim/config/key.h"
#include "hwsim/units/ranges.h"
#include "hwsim/units/unit_work.h"

namespace hwsim::units {

/// L2 and the last-level cache.
struct L2 {
  static constexpr UnitInfo kInfo = {"l2", UnitPlace::memory, set_of(), "bytes / `l2_bytes_per_clk`"};

  template <class T>
  struct Values {
    bool rop_through_l2 = true;
    T l2_size_kib{0.0};
    T l2_bytes_per_clk{0.0};
    T l2_latency_cycles{220.0};
    int l2_ways = 16;
    T llc_size_kib{0.0};
    T unit_lines_max{512.0};
    int compression_granule_bytes = 32;
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key({"rop_through_l2", 0, 0, kNeither,
           "depth and color go through L2; otherwise through the ROPs' own caches"},
          c.rop_through_l2);
    v.key({"l2_size_kib", 1, kKibHigh, kRequired | kFaster, "L2 of the chip (Intel: L3)"}, c.l2_size_kib);
    v.key({"l2_bytes_per_clk", kRateLow, kRateHigh, kRequired | kFit | kFaster, "L2 bandwidth"},
          c.l2_bytes_per_clk);
    v.key({"l2_latency_cycles", 0, 1e5, kSlower, "core clocks of a read that hits in L2"},
          c.l2_latency_cycles);
    v.key({"l2_ways", 1, 128, kNeither, "engine detailed: lines of a set of L2"}, c.l2_ways);
    v.key(
        {"llc_size_kib", 0, kKibHigh, kFaster, "cache between L2 and DRAM (Intel LLC, Infinity Cache, SLC)"},
        c.llc_size_kib);
    v.key({"unit_lines_max", 1, 1e6, kFaster,
           "64-byte lines that a fixed-function unit can have on their way from and to L2 and DRAM"},
          c.unit_lines_max);
    v.key(
        {"compression_granule_bytes", 1, 4096, kSlower, "compressed tiles and blocks move in whole granules"},
        c.compression_granule_bytes);
  }

  template <class T>
  struct Rates {
    T l2_byte_ns, l2_latency_ns, llc_bytes;
    T l2_bytes;    ///< with the last-level cache behind it
    T unit_lines;  ///< that a fixed-function unit has on their way
    int compression_granule_bytes;
    bool rop_through_l2;
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    r.l2_byte_ns = clk_ns / c.l2_bytes_per_clk;
    r.l2_latency_ns = c.l2_latency_cycles * clk_ns;
    r.l2_bytes = (c.l2_size_kib + c.llc_size_kib) * kBytesPerKib;
    r.llc_bytes = c.llc_size_kib * kBytesPerKib;
    r.unit_lines = c.unit_lines_max;
    r.compression_granule_bytes = c.compression_granule_bytes;
    r.rop_through_l2 = c.rop_through_l2;
  }

  template <class T, class R>
  static T service_ns(const UnitWork<T>& w, const R& r) {
    return w.traffic.l2_bytes * r.l2_byte_ns;
  }
};

}  // namespace hwsim::units
