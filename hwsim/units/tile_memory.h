#pragma once
// Memory on the chip that holds the depth and color of a screen tile. No unit of the chain: it changes what
// the others move.
#include "hwsim/base/units_of_measure.h"
#include "hwsim/config/key.h"
#include "hwsim/units/ranges.h"

namespace hwsim::units {

/// Tile memory of GPUs that render tile by tile.
struct TileMemory {
  template <class T>
  struct Values {
    bool tile_based = false;
    int tile_px = 256;
    T tile_list_entry_bytes{8.0};
    T tile_memory_kib{8.0};
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key({"tile_based", 0, 0, kNeither,
           "depth and color of a pass live in tile memory; geometry is binned through DRAM"},
          c.tile_based);
    v.key(
        {"tile_px", 16, 65536, kNeither, "pixels of a screen tile, where the color of one fits tile memory"},
        c.tile_px);
    v.key({"tile_list_entry_bytes", 1, 1024, kSlower,
           "bytes that binning writes for a triangle in the list of a tile, and that the tile reads back"},
          c.tile_list_entry_bytes);
    v.key({"tile_memory_kib", kRatioLow, kKibHigh, kFaster,
           "color of a tile, all samples and targets: what needs more halves the tile"},
          c.tile_memory_kib);
  }

  template <class T>
  struct Rates {
    T tile_memory_bytes, tile_list_entry_bytes;
    int tile_px;
    bool tile_based;
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    r.tile_memory_bytes = c.tile_memory_kib * kBytesPerKib;
    r.tile_list_entry_bytes = c.tile_list_entry_bytes;
    r.tile_px = c.tile_px;
    r.tile_based = c.tile_based;
    static_cast<void>(clk_ns);
  }
};

}  // namespace hwsim::units
