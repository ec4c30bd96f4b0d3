#pragma once
// Bytes that a pass moves through L2 and DRAM, from what its units asked for (docs/hardware_model.md,
// "Memory").
//   moved = compulsory + miss * (requested - compulsory),   miss = max(0, 1 - cache / footprint)
// compulsory: the first touch of each block in the pass; it costs no read where the target was cleared. The
// footprint is that of the pass, so locality between neighbors in a large pass is underrated; reuse distances
// would say it exactly.
#include <algorithm>
#include <array>
#include <cstddef>

#include "hwsim/config/gpu_rates.h"
#include "hwsim/timing/timing.h"
#include "hwsim/work_trace.h"

namespace hwsim {

inline constexpr double kTilePixels = 64.0;        // the trace's tiles are 8x8 pixels
inline constexpr double kTextureLineBytes = 64.0;  // and its texture lines 64 bytes

constexpr std::size_t at(Stream stream) { return static_cast<std::size_t>(stream); }
constexpr std::size_t at(Unit unit) { return static_cast<std::size_t>(unit); }

template <class T>
struct StreamBytesOf {
  std::array<T, kStreamCount> read, write;
  StreamBytesOf() {
    read.fill(T(0.0));
    write.fill(T(0.0));
  }
  StreamBytesOf& operator+=(const StreamBytesOf& other) {
    for (std::size_t i = 0; i < kStreamCount; ++i) {
      read[i] += other.read[i];
      write[i] += other.write[i];
    }
    return *this;
  }
  T total() const {
    T sum(0.0);
    for (std::size_t i = 0; i < kStreamCount; ++i) sum += read[i] + write[i];
    return sum;
  }
};

/// What does not depend on the GPU, once a pass.
struct PassShape {
  double color_tile_bytes = 0.0;  ///< mean of the targets
  double depth_tile_bytes = 0.0;
  double color_samples = 1.0;       ///< mean of the targets
  double uncompressed_ratio = 1.0;  ///< color samples written outside of single-color pixels / all written
  double color_footprint_bytes = 0.0;
  double depth_footprint_bytes = 0.0;
  StreamBytes requested;   ///< capped at the tiles touched; without textures
  StreamBytes compulsory;  ///< of these
  double texture_footprint_bytes = 0.0;
  PassCounters sum;
};

/// What a chunk asks of memory, by stream, without textures. Overdraw inside a chunk stays in the ROP: a tile
/// moves at most once for each chunk that uses it.
StreamBytes requested_bytes(const PassCounters& chunk, const PassShape& shape);

PassShape shape_of(const PassWork& pass);

template <class T>
struct TrafficModel {
  StreamBytesOf<T> factor;  ///< DRAM bytes a requested byte
  T texture_miss{0.0};
  T color_scale{1.0};  ///< multisample compression, in DRAM and L2
};

template <class T>
T miss_ratio(const T& cache_bytes, double footprint_bytes) {
  if (footprint_bytes <= 0.0) return T(0.0);
  return larger(T(0.0), T(1.0 - cache_bytes / footprint_bytes));
}

/// DRAM bytes a requested byte of a stream.
template <class T>
T moved_factor(double requested, double compulsory, const T& miss, bool first_touch_free) {
  if (requested <= 0.0) return T(0.0);
  return ((first_touch_free ? 0.0 : compulsory) + miss * (requested - compulsory)) / requested;
}

template <class T>
TrafficModel<T> model_traffic(const PassShape& shape, const PassWork& pass, const GpuRates<T>& rates) {
  TrafficModel<T> model;
  const StreamBytes& first = shape.compulsory;
  const auto both = [&first](Stream s) { return first.read[at(s)] + first.write[at(s)]; };
  const double buffers = both(Stream::storage) + both(Stream::vertex) + both(Stream::index);
  const double rop = rates.rop_through_l2 ? shape.color_footprint_bytes + shape.depth_footprint_bytes : 0.0;
  const T l2_miss = miss_ratio(rates.l2_bytes, buffers + rop + shape.texture_footprint_bytes);
  T color_miss =
      rates.rop_through_l2 ? l2_miss : miss_ratio(rates.crop_cache_bytes, shape.color_footprint_bytes);
  T depth_miss =
      rates.rop_through_l2 ? l2_miss : miss_ratio(rates.zrop_cache_bytes, shape.depth_footprint_bytes);
  if (rates.tile_based) color_miss = depth_miss = T(0.0);  // a tile is loaded and stored once a pass
  model.texture_miss = l2_miss;
  if (rates.msaa_color_compression && shape.color_samples > 1.0)
    model.color_scale = T(shape.uncompressed_ratio + (1.0 - shape.uncompressed_ratio) / shape.color_samples);
  const auto set = [&](Stream s, const T& miss, bool cleared) {
    const auto i = at(s);
    model.factor.read[i] = moved_factor(shape.requested.read[i], first.read[i], miss, cleared);
    model.factor.write[i] = moved_factor(shape.requested.write[i], first.write[i], miss, false);
  };
  set(Stream::color, color_miss, pass.color_cleared_before);
  set(Stream::depth, depth_miss, pass.depth_cleared_before);
  for (const Stream s :
       {Stream::storage, Stream::vertex, Stream::index, Stream::constant, Stream::shader, Stream::other})
    set(s, l2_miss, false);
  const T color = model.color_scale * rates.color_traffic_ratio;
  model.factor.read[at(Stream::color)] *= color;
  model.factor.write[at(Stream::color)] *= color;
  model.factor.read[at(Stream::depth)] *= rates.depth_traffic_ratio;
  model.factor.write[at(Stream::depth)] *= rates.depth_traffic_ratio;
  return model;
}

template <class T>
struct ChunkTraffic {
  StreamBytesOf<T> dram;
  T l2_bytes{0.0};
  T l1_fill_bytes{0.0};
  /// Lines that a subgroup waits for: textures beyond L1, storage always.
  T l1_missed_lines() const { return (l1_fill_bytes + storage_read_bytes) / kTextureLineBytes; }
  T l2_missed_lines() const {
    return (dram.read[at(Stream::texture)] + dram.read[at(Stream::storage)]) / kTextureLineBytes;
  }
  T storage_read_bytes{0.0};
};

/// Texture lines that miss L1: first touches, and re-touches scaled from the trace's 16 KiB to the GPU's L1.
template <class T>
T l1_missed_lines(const PassCounters& c, const GpuRates<T>& rates) {
  const auto first = static_cast<double>(c.tex.first_touched_lines);
  const auto again = std::max(0.0, static_cast<double>(c.tex.touched_lines) - first);
  const T lines = first + again * rates.l1_retouch_ratio;
  return smaller(lines, T(std::max(first + again, static_cast<double>(c.tex.texels))));
}

template <class T>
ChunkTraffic<T> chunk_traffic(const PassCounters& c, const PassShape& shape, const TrafficModel<T>& model,
                              const GpuRates<T>& rates) {
  ChunkTraffic<T> traffic;
  const StreamBytes asked = requested_bytes(c, shape);
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    traffic.dram.read[i] = asked.read[i] * model.factor.read[i];
    traffic.dram.write[i] = asked.write[i] * model.factor.write[i];
    const bool rop = i == at(Stream::color) || i == at(Stream::depth);
    if (rop && (!rates.rop_through_l2 || rates.tile_based)) continue;
    const T bytes(asked.read[i] + asked.write[i]);
    traffic.l2_bytes += i == at(Stream::color) ? T(bytes * model.color_scale) : bytes;
  }
  traffic.storage_read_bytes = T(asked.read[at(Stream::storage)]);
  const T lines = l1_missed_lines(c, rates);
  const auto first = static_cast<double>(c.tex.first_touched_lines);
  traffic.l1_fill_bytes = lines * kTextureLineBytes;
  traffic.l2_bytes += traffic.l1_fill_bytes;
  traffic.dram.read[at(Stream::texture)] = (first + model.texture_miss * (lines - first)) * kTextureLineBytes;
  if (rates.tile_based) {  // vertices that binning writes and the tiles read back
    const double binned = 4.0 * static_cast<double>(c.vs.output_scalars);
    traffic.dram.write[at(Stream::other)] += binned;
    traffic.dram.read[at(Stream::other)] += binned;
  }
  return traffic;
}

}  // namespace hwsim
