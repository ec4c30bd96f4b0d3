#pragma once
// The front end: it reads the command stream.
#include "hwsim/config/key.h"
#include "hwsim/units/ranges.h"
#include "hwsim/units/unit_work.h"

namespace hwsim::units {

/// The front end: draws and changes of state.
struct FrontEnd {
  static constexpr UnitInfo kInfo = {"fe", UnitPlace::front, set_of(),
                                     "draws x `draw_cycles` + state changes x `state_change_cycles`"};

  template <class T>
  struct Values {
    T draw_cycles{8.0};
    T state_change_cycles{16.0};
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key({"draw_cycles", 0, 1e6, kFit | kSlower, "front end, a draw"}, c.draw_cycles);
    v.key({"state_change_cycles", 0, 1e6, kFit | kSlower, "front end, a pipeline or binding change"},
          c.state_change_cycles);
  }

  template <class T>
  struct Rates {
    T draw_ns, state_change_ns;
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    r.draw_ns = clk_ns * c.draw_cycles;
    r.state_change_ns = clk_ns * c.state_change_cycles;
  }

  template <class T, class R>
  static T service_ns(const UnitWork<T>& w, const R& r) {
    return static_cast<double>(w.counters.fe.draws) * r.draw_ns +
           static_cast<double>(w.counters.fe.state_changes) * r.state_change_ns;
  }
};

}  // namespace hwsim::units
