#pragma once
// The coarse depth test of 8x8 tiles.
#include "hwsim/config/key.h"
#include "hwsim/units/ranges.h"
#include "hwsim/units/unit_work.h"

namespace hwsim::units {

/// The coarse depth test.
struct HierarchicalZ {
  static constexpr UnitInfo kInfo = {"hiz", UnitPlace::front, set_of(),
                                     "64 x tiles tested / `hiz_px_per_clk`"};

  template <class T>
  struct Values {
    T hiz_px_per_clk{0.0};
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key({"hiz_px_per_clk", kRateLow, kRateHigh, kRequired | kFit | kFaster,
           "pixels rejected by the coarse depth test"},
          c.hiz_px_per_clk);
  }

  template <class T>
  struct Rates {
    T hiz_px_ns;
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    r.hiz_px_ns = clk_ns / c.hiz_px_per_clk;
  }

  template <class T, class R>
  static T service_ns(const UnitWork<T>& w, const R& r) {
    return static_cast<double>(w.counters.hiz.tested_tiles) * kTilePixels * r.hiz_px_ns;
  }
};

}  // namespace hwsim::units
