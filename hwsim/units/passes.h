#pragma once
// How passes follow each other, and how engines join the units: no unit of the chain.
#include "hwsim/base/units_of_measure.h"
#include "hwsim/config/key.h"
#include "hwsim/units/ranges.h"

namespace hwsim::units {

/// Passes, queues between the units, and the roofline.
struct Passes {
  template <class T>
  struct Values {
    T pass_overhead_us{10.0};
    int queue_packets = 64;
    T roofline_exponent{8.0};
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key({"pass_overhead_us", 0, 1e6, kFit | kSlower,
           "fixed cost of a pass that waits for an earlier one: drain, launch"},
          c.pass_overhead_us);
    v.key({"queue_packets", 2, 4096, kFaster,
           "subgroups' worth of work that wait between two units; engines queue and detailed"},
          c.queue_packets);
    v.key({"roofline_exponent", 1, 64, kFaster,
           "engine roofline: p of the norm over units; large: only the limiter counts"},
          c.roofline_exponent);
  }

  template <class T>
  struct Rates {
    T pass_overhead_ns, roofline_exponent;
    int queue_packets;
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    r.pass_overhead_ns = c.pass_overhead_us * kNsPerUs;
    r.roofline_exponent = c.roofline_exponent;
    r.queue_packets = c.queue_packets;
    static_cast<void>(clk_ns);
  }
};

}  // namespace hwsim::units
