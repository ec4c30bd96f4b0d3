#pragma once
// Vertex shading, and what geometry shaders emit. What geometry shaders compute is shader work as any
// other.
#include "hwsim/config/key.h"
#include "hwsim/units/ranges.h"
#include "hwsim/units/unit_work.h"

namespace hwsim::units {

/// Vertex shading, and the output of geometry shaders.
struct VertexShading {
  static constexpr UnitInfo kInfo = {"vs", UnitPlace::front, set_of(),
                                     "max(the vertex shaders' part of `shader`, alone; values that geometry "
                                     "shaders emit / (`shader_cores` x `gs_output_words_per_core_clk`))"};

  template <class T>
  struct Values {
    T gs_output_words_per_core_clk{4.0};
    bool gs_on_chip = true;
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key({"gs_output_words_per_core_clk", kRateLow, kRateHigh, kFit | kFaster,
           "32-bit values that geometry shaders emit, a core clock and core"},
          c.gs_output_words_per_core_clk);
    v.key({"gs_on_chip", 0, 0, kFaster,
           "geometry shaders' input and output stay on chip; else memory holds them between the stages"},
          c.gs_on_chip);
  }

  template <class T>
  struct Rates {
    T gs_output_word_ns;
    bool gs_on_chip;
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    r.gs_output_word_ns = clk_ns / (c.shader_cores * c.gs_output_words_per_core_clk);
    r.gs_on_chip = c.gs_on_chip;
  }

  template <class T, class R>
  static T service_ns(const UnitWork<T>& w, const R& r) {
    const T shading = larger(T(static_cast<double>(w.counters.vs.alu_lane_ops) * r.alu_lane_op_ns),
                             T(static_cast<double>(w.counters.vs.sfu_lane_ops) * r.sfu_lane_op_ns));
    return larger(shading, T(static_cast<double>(w.counters.gs.output_bytes) / 4.0 * r.gs_output_word_ns));
  }
};

}  // namespace hwsim::units
