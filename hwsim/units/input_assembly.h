#pragma once
// Input assembly: it fetches indices and attributes of vertices.
#include "hwsim/config/key.h"
#include "hwsim/units/ranges.h"
#include "hwsim/units/unit_work.h"

namespace hwsim::units {

/// Input assembly: indices and attributes of vertices.
struct InputAssembly {
  static constexpr UnitInfo kInfo = {
      "ia", UnitPlace::front, set_of(Stream::vertex, Stream::index, Stream::constant),
      "indices / `ia_indices_per_clk` (0: three for each triangle of the faster setup rate)"};

  template <class T>
  struct Values {
    T ia_indices_per_clk{0.0};
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key({"ia_indices_per_clk", 0, kRateHigh, kFaster,
           "indices fetched; 0: three for each triangle that setup can cull"},
          c.ia_indices_per_clk);
  }

  template <class T>
  struct Rates {
    T index_ns;
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    const T fastest = larger(c.setup_culled_triangles_per_clk, c.setup_drawn_triangles_per_clk);
    r.index_ns = clk_ns / (c.ia_indices_per_clk > T(0.0) ? c.ia_indices_per_clk : T(fastest * 3.0));
  }

  template <class T, class R>
  static T service_ns(const UnitWork<T>& w, const R& r) {
    return static_cast<double>(w.counters.stats.input_assembly_vertices) * r.index_ns;
  }
};

}  // namespace hwsim::units
