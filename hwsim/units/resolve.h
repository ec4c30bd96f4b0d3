#pragma once
// Resolves: samples of a multisampled image averaged to pixels.
#include "hwsim/config/key.h"
#include "hwsim/trace/format.h"
#include "hwsim/units/ranges.h"
#include "hwsim/units/unit_work.h"

namespace hwsim::units {

/// Resolves of multisampled images.
struct Resolve {
  static constexpr UnitInfo kInfo = {
      "resolve", UnitPlace::rops, set_of(),
      "max(samples read / `resolve_samples_per_clk` (0: the texture rate), pixels written / pixel rate)"};

  template <class T>
  struct Values {
    T resolve_samples_per_clk{0.0};
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key(
        {"resolve_samples_per_clk", 0, kRateHigh, kFaster, "samples averaged; 0: at the texture units' rate"},
        c.resolve_samples_per_clk);
  }

  template <class T>
  struct Rates {
    T resolve_sample_ns;
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    const bool by_texture = !(c.resolve_samples_per_clk > T(0.0));
    r.resolve_sample_ns = by_texture ? r.bilinear_probe_ns : T(clk_ns / c.resolve_samples_per_clk);
  }

  template <class T, class R>
  static T service_ns(const UnitWork<T>& w, const R& r) {
    const T read = static_cast<double>(w.counters.resolve.read_samples) * r.resolve_sample_ns;
    if (w.pass.color_targets.empty()) return read;
    const auto k = static_cast<std::size_t>(info(w.pass.color_targets.front().format).rate_class);
    if (k >= static_cast<std::size_t>(RateClass::depth)) return read;
    return larger(read, T(static_cast<double>(w.counters.resolve.written_pixels) * r.color_px_ns[k]));
  }
};

}  // namespace hwsim::units
