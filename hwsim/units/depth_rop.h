#pragma once
// Depth units of the ROPs: tests, writes, their caches, clears and the forms of compressed depth tiles.
#include <algorithm>
#include <cstdint>

#include "hwsim/base/units_of_measure.h"
#include "hwsim/config/key.h"
#include "hwsim/units/ranges.h"
#include "hwsim/units/unit_work.h"

namespace hwsim::units {

/// Depth units of the ROPs.
struct DepthRop {
  static constexpr UnitInfo kInfo = {"zrop", UnitPlace::front, set_of(Stream::depth),
                                     "max(samples tested, samples written) / (`crop_units` x "
                                     "`zrop_samples_per_unit_clk` x `zrop_efficiency_ratio`)"};

  template <class T>
  struct Values {
    T zrop_samples_per_unit_clk{0.0};
    T zrop_efficiency_ratio{1.0};
    T zrop_cache_kib{16.0};
    bool fast_clear_depth = true;
    T fast_clear_depth_bytes_per_tile{4.0};
    int depth_plane_slots = 4;
    bool depth_offset_forms = false;
    bool shader_read_expands_depth = false;
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key({"zrop_samples_per_unit_clk", kRateLow, kRateHigh, kRequired | kFaster,
           "depth samples tested and written, a clock and ROP"},
          c.zrop_samples_per_unit_clk);
    v.key({"zrop_efficiency_ratio", kRatioLow, 1, kFit | kFaster, "of that, reached"},
          c.zrop_efficiency_ratio);
    v.key({"zrop_cache_kib", 0, kKibHigh, kFaster, "depth caches of the chip, before L2 or instead of it"},
          c.zrop_cache_kib);
    v.key({"fast_clear_depth", 0, 0, kFaster, "clears of depth write a tile table only"}, c.fast_clear_depth);
    v.key({"fast_clear_depth_bytes_per_tile", 0, 1e4, kSlower, "table bytes of an 8x8 depth tile"},
          c.fast_clear_depth_bytes_per_tile);
    v.key({"depth_plane_slots", 0, 4, kFaster,
           "planes that a compressed 8x8 depth tile can hold: 4, 2 (as is 3), 1 or none"},
          c.depth_plane_slots);
    v.key({"depth_offset_forms", 0, 0, kFaster,
           "depth tiles as 6- or 14-bit distances from their nearest or farthest value"},
          c.depth_offset_forms);
    v.key({"shader_read_expands_depth", 0, 0, kSlower,
           "depth that was drawn is decompressed in place before a shader reads it"},
          c.shader_read_expands_depth);
  }

  template <class T>
  struct Rates {
    T zrop_sample_ns, zrop_cache_bytes, clear_depth_tile_bytes;
    int depth_plane_slots;
    bool fast_clear_depth, depth_offset_forms, shader_read_expands_depth;
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    r.zrop_sample_ns = clk_ns / (c.crop_units * c.zrop_samples_per_unit_clk * c.zrop_efficiency_ratio);
    r.zrop_cache_bytes = c.zrop_cache_kib * kBytesPerKib;
    r.clear_depth_tile_bytes = c.fast_clear_depth_bytes_per_tile;
    r.depth_plane_slots = c.depth_plane_slots;
    r.fast_clear_depth = c.fast_clear_depth;
    r.depth_offset_forms = c.depth_offset_forms;
    r.shader_read_expands_depth = c.shader_read_expands_depth;
  }

  template <class T, class R>
  static T service_ns(const UnitWork<T>& w, const R& r) {
    const ZropCounters& c = w.counters.zrop;
    const std::uint64_t tested = c.early_z_tested_samples + c.late_z_tested_samples;
    return static_cast<double>(std::max(tested, c.written_samples)) * r.zrop_sample_ns;
  }
};

}  // namespace hwsim::units
