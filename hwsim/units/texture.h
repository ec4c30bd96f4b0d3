#pragma once
// Texture units of the cores, with their L1. An unfiltered texel takes the place of a probe, a wide one of
// several; so does a gather, and a filtered comparison. (Filtered textures are 32-bit.)
#include "hwsim/base/units_of_measure.h"
#include "hwsim/config/key.h"
#include "hwsim/units/ranges.h"
#include "hwsim/units/unit_work.h"

namespace hwsim {

/// An unfiltered texel takes the place of a probe, a wide one of several. (Filtered textures are 32-bit.)
template <class R, class T = typename R::Scalar>
T fetch_ns(const PassCounters& c, const R& r) {
  return (static_cast<double>(c.tex.fetched_32bit_texels) +
          static_cast<double>(c.tex.fetched_64bit_texels) * r.fetch_64bit_cost +
          static_cast<double>(c.tex.fetched_128bit_texels) * r.fetch_128bit_cost) *
         r.bilinear_probe_ns;
}

template <class R, class T = typename R::Scalar>
T tex_pipe_ns(const PassCounters& c, const R& r) {
  return static_cast<double>(c.tex.bilinear_probes) * r.bilinear_probe_ns +
         (static_cast<double>(c.tex.gathers) * r.gather_cost +
          static_cast<double>(c.tex.comparisons) * r.comparison_cost) *
             r.bilinear_probe_ns +
         fetch_ns(c, r);
}

}  // namespace hwsim

namespace hwsim::units {

/// Texture units, with L1.
struct Texture {
  static constexpr UnitInfo kInfo = {
      "tex", UnitPlace::cores, set_of(),
      "max((bilinear probes + gathers / `tex_gather_ratio` + comparisons / `tex_comparison_ratio` + "
      "unfiltered texels x size cost) / (`tex_bilinear_per_clk` x "
      "`tex_efficiency_ratio`), L1 fills / (`shader_cores` x `l1_fill_bytes_per_core_clk`))"};

  template <class T>
  struct Values {
    T tex_bilinear_per_clk{0.0};
    T tex_64bit_ratio{1.0};
    T tex_128bit_ratio{0.25};
    T tex_gather_ratio{1.0};
    T tex_comparison_ratio{1.0};
    T tex_efficiency_ratio{1.0};
    T tex_latency_cycles{150.0};
    T l1_size_kib{16.0};
    int l1_ways = 8;
    T l1_fill_bytes_per_core_clk{64.0};
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key({"tex_bilinear_per_clk", kRateLow, kRateHigh, kRequired | kFaster,
           "bilinear probes, or unfiltered texels, of 32 bits"},
          c.tex_bilinear_per_clk);
    v.key({"tex_64bit_ratio", kRatioLow, 1, kFaster, "speed of unfiltered 64-bit texels, relative"},
          c.tex_64bit_ratio);
    v.key({"tex_128bit_ratio", kRatioLow, 1, kFaster, "speed of unfiltered 128-bit texels, relative"},
          c.tex_128bit_ratio);
    v.key({"tex_gather_ratio", kRatioLow, 1, kFaster,
           "speed of gathers of one channel of 2x2 texels, relative to bilinear probes"},
          c.tex_gather_ratio);
    v.key({"tex_comparison_ratio", kRatioLow, 1, kFaster,
           "speed of filtered comparisons with a 32-bit depth, relative to bilinear probes"},
          c.tex_comparison_ratio);
    v.key({"tex_efficiency_ratio", kRatioLow, 1, kFit | kFaster, "of the probe rate, reached"},
          c.tex_efficiency_ratio);
    v.key({"tex_latency_cycles", 0, 1e5, kSlower,
           "core clocks of a texture request that hits in L1; part of the latencies below"},
          c.tex_latency_cycles);
    v.key({"l1_size_kib", 0.25, kKibHigh, kFaster, "texture cache of a core"}, c.l1_size_kib);
    v.key({"l1_ways", 1, 128, kNeither, "engine detailed: lines of a set of L1"}, c.l1_ways);
    v.key({"l1_fill_bytes_per_core_clk", kRateLow, kRateHigh, kFaster, "L2 to L1, a core clock and core"},
          c.l1_fill_bytes_per_core_clk);
  }

  template <class T>
  struct Rates {
    T bilinear_probe_ns, fetch_64bit_cost, fetch_128bit_cost, gather_cost, comparison_cost, tex_latency_ns,
        l1_fill_byte_ns, l1_bytes;
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    r.bilinear_probe_ns = clk_ns / (c.tex_bilinear_per_clk * c.tex_efficiency_ratio);
    r.fetch_64bit_cost = 1.0 / c.tex_64bit_ratio;
    r.fetch_128bit_cost = 1.0 / c.tex_128bit_ratio;
    r.gather_cost = 1.0 / c.tex_gather_ratio;
    r.comparison_cost = 1.0 / c.tex_comparison_ratio;
    r.tex_latency_ns = c.tex_latency_cycles * clk_ns;
    r.l1_fill_byte_ns = clk_ns / (c.shader_cores * c.l1_fill_bytes_per_core_clk);
    r.l1_bytes = c.l1_size_kib * kBytesPerKib;
  }

  template <class T, class R>
  static T service_ns(const UnitWork<T>& w, const R& r) {
    return larger(tex_pipe_ns(w.counters, r), T(w.traffic.l1_fill_bytes * r.l1_fill_byte_ns));
  }
};

}  // namespace hwsim::units
