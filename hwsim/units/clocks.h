#pragma once
// The clocks of a GPU. No unit of the chain: every rate is in one of them.
#include "hwsim/config/key.h"
#include "hwsim/units/ranges.h"

namespace hwsim::units {

/// The clocks.
struct Clocks {
  template <class T>
  struct Values {
    T core_clock_mhz{0.0};
    T shader_clock_ratio{1.0};
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key({"core_clock_mhz", 1, 1e5, kRequired | kFit | kFaster,
           "clock of everything but DRAM and the shader lanes"},
          c.core_clock_mhz);
    v.key({"shader_clock_ratio", 0.1, 10, kFaster,
           "shader lanes' clock over the core clock (2 on Fermi: the hot clock)"},
          c.shader_clock_ratio);
  }

  template <class T>
  struct Rates {
    T shader_clk_ns;
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    r.shader_clk_ns = clk_ns / c.shader_clock_ratio;
  }
};

}  // namespace hwsim::units
