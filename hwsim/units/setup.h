#pragma once
// Culling and triangle setup: stages of one pipe, so that the slower one sets the pace.
#include "hwsim/config/key.h"
#include "hwsim/units/ranges.h"
#include "hwsim/units/unit_work.h"

namespace hwsim::units {

/// Culling and setup of triangles.
struct Setup {
  static constexpr UnitInfo kInfo = {
      "setup", UnitPlace::front, set_of(),
      "max(triangles in / `setup_culled_triangles_per_clk`, triangles out / "
      "`setup_drawn_triangles_per_clk`): culling and setup are stages of one pipe"};

  template <class T>
  struct Values {
    T setup_drawn_triangles_per_clk{0.0};
    T setup_culled_triangles_per_clk{0.0};
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key({"setup_drawn_triangles_per_clk", kRateLow, kRateHigh, kRequired | kFit | kFaster,
           "triangles sent to raster"},
          c.setup_drawn_triangles_per_clk);
    v.key({"setup_culled_triangles_per_clk", kRateLow, kRateHigh, kRequired | kFit | kFaster,
           "triangles that pass the culling stage, drawn ones too"},
          c.setup_culled_triangles_per_clk);
  }

  template <class T>
  struct Rates {
    T culled_triangle_ns, drawn_triangle_ns;
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    r.culled_triangle_ns = clk_ns / c.setup_culled_triangles_per_clk;
    r.drawn_triangle_ns = clk_ns / c.setup_drawn_triangles_per_clk;
  }

  template <class T, class R>
  static T service_ns(const UnitWork<T>& w, const R& r) {
    return larger(T(static_cast<double>(w.counters.setup.in_primitives) * r.culled_triangle_ns),
                  T(static_cast<double>(w.counters.setup.out_primitives) * r.drawn_triangle_ns));
  }
};

}  // namespace hwsim::units
