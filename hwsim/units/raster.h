#pragma once
// Rasterizers. Pixels are charged by whole quads (small triangles), and at least once where all samples
// failed the depth test.
#include <algorithm>

#include "hwsim/config/key.h"
#include "hwsim/units/ranges.h"
#include "hwsim/units/unit_work.h"

namespace hwsim::units {

/// The rasterizers.
struct Raster {
  static constexpr UnitInfo kInfo = {
      "raster", UnitPlace::front, set_of(),
      "max(pixels / (`raster_engines` x `raster_px_per_engine_clk`), samples / `raster_samples_per_clk`, "
      "tiles visited / (`raster_engines` x `raster_tiles_per_engine_clk`)); pixels = max(4 x quads, covered "
      "samples / sample count)"};

  template <class T>
  struct Values {
    T raster_engines{1.0};
    T raster_px_per_engine_clk{0.0};
    T raster_samples_per_clk{0.0};
    T raster_tiles_per_engine_clk{1.0};
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key({"raster_engines", 1, 1e4, kFaster | kWhole, "rasterizers, each on its own triangle"},
          c.raster_engines);
    v.key({"raster_px_per_engine_clk", kRateLow, kRateHigh, kRequired | kFit | kFaster,
           "pixels, a clock and rasterizer"},
          c.raster_px_per_engine_clk);
    v.key({"raster_samples_per_clk", kRateLow, kRateHigh, kRequired | kFaster, "samples tested for coverage"},
          c.raster_samples_per_clk);
    v.key({"raster_tiles_per_engine_clk", kRateLow, kRateHigh, kFaster,
           "8x8 tiles visited, a clock and rasterizer"},
          c.raster_tiles_per_engine_clk);
  }

  template <class T>
  struct Rates {
    T raster_px_ns, raster_sample_ns, raster_tile_ns;
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    r.raster_px_ns = clk_ns / (c.raster_engines * c.raster_px_per_engine_clk);
    r.raster_sample_ns = clk_ns / c.raster_samples_per_clk;
    r.raster_tile_ns = clk_ns / (c.raster_engines * c.raster_tiles_per_engine_clk);
  }

  template <class T, class R>
  static T service_ns(const UnitWork<T>& w, const R& r) {
    const RasterCounters& c = w.counters.raster;
    const auto samples = static_cast<double>(c.covered_samples);
    const double px =
        std::max(4.0 * static_cast<double>(c.quads), samples / std::max(1, w.pass.raster_samples));
    const T by_px = larger(T(px * r.raster_px_ns), T(samples * r.raster_sample_ns));
    return larger(by_px, T(static_cast<double>(c.visited_tiles) * r.raster_tile_ns));
  }
};

}  // namespace hwsim::units
