#pragma once
// Bytes that a pass moves through L2 and DRAM, from what its units asked for and the reuse distances that the
// trace keeps (docs/hardware_model.md, "Memory"): of the bytes that a stream requests in a pass, a cache of
// the GPU's size lets a part through, and each chunk's requests are charged that part.
#include <algorithm>
#include <array>
#include <cstddef>

#include "hwsim/config/gpu_rates.h"
#include "hwsim/timing/timing.h"
#include "hwsim/work_trace.h"

namespace hwsim {

inline constexpr double kTilePixels = 64.0;        // the trace's tiles are 8x8 pixels
inline constexpr double kTextureLineBytes = 64.0;  // and its lines 64 bytes

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
  double color_samples = 1.0;       ///< mean of the targets
  double uncompressed_ratio = 1.0;  ///< color samples written outside of single-color pixels / all written
  PassCounters sum;
};

/// What a chunk asks of memory, by stream, textures included.
StreamBytes requested_bytes(const PassCounters& chunk);

PassShape shape_of(const PassWork& pass);

/// Bytes moved for each byte requested.
template <class T>
struct TrafficModel {
  StreamBytesOf<T> dram, l2;
  T l1_fill{1.0};  ///< texture bytes beyond L1
};

template <class T>
struct MovedRatio {
  T read, write;
};

/// A target that was cleared is not read for a block's first stay. Rounding may end a line below zero.
template <class T>
MovedRatio<T> moved_by(const MissCurve& curve, const T& cache_bytes, bool cleared_before) {
  std::array<std::uint64_t, kCacheSizes> read = curve.read_bytes;
  if (cleared_before)
    for (std::size_t k = 0; k < read.size(); ++k) read[k] -= curve.first_read_bytes[k];
  return {larger(moved_ratio(read, curve.requested_read_bytes, cache_bytes), T(0.0)),
          larger(moved_ratio(curve.write_bytes, curve.requested_write_bytes, cache_bytes), T(0.0))};
}

/// Color or depth: a cache in the ROPs, and L2 behind it where they go through it. Tile memory keeps a tile
/// for the whole pass.
template <class T>
void model_rop(const PassWork& pass, ReuseStream reuse, const GpuRates<T>& r, TrafficModel<T>& model) {
  const bool color = reuse == ReuseStream::color;
  const std::size_t i = at(color ? Stream::color : Stream::depth);
  const bool cleared = color ? pass.color_cleared_before : pass.depth_cleared_before;
  const T& own_cache = color ? r.crop_cache_bytes : r.zrop_cache_bytes;
  const MissCurve& apart = pass.reuse.apart[at(reuse)];
  const bool through_l2 = r.rop_through_l2 && !r.tile_based;
  const T whole_pass(kSmallestCacheBytes * (1 << (kCacheSizes - 1)));
  const MovedRatio<T> dram = r.tile_based ? moved_by(apart, whole_pass, cleared)
                             : through_l2 ? moved_by(pass.reuse.shared[at(reuse)], r.l2_bytes, cleared)
                                          : moved_by(apart, T(own_cache + r.llc_bytes), cleared);
  const MovedRatio<T> l2 = through_l2 ? moved_by(apart, own_cache, cleared) : MovedRatio<T>{T(0.0), T(0.0)};
  model.dram.read[i] = dram.read;
  model.dram.write[i] = dram.write;
  model.l2.read[i] = larger(l2.read, through_l2 ? dram.read : T(0.0));
  model.l2.write[i] = larger(l2.write, through_l2 ? dram.write : T(0.0));
}

template <class T>
TrafficModel<T> model_traffic(const PassShape& shape, const PassWork& pass, const GpuRates<T>& rates) {
  TrafficModel<T> model;
  model.dram.read.fill(T(1.0));
  model.dram.write.fill(T(1.0));
  model.l2 = model.dram;
  model_rop(pass, ReuseStream::color, rates, model);
  model_rop(pass, ReuseStream::depth, rates, model);
  const auto& in_l2 = rates.rop_through_l2 && !rates.tile_based ? pass.reuse.shared : pass.reuse.apart;
  const auto set = [&](Stream stream, ReuseStream reuse) {
    const MovedRatio<T> moved = moved_by(in_l2[at(reuse)], rates.l2_bytes, false);
    model.dram.read[at(stream)] = moved.read;
    model.dram.write[at(stream)] = moved.write;
  };
  set(Stream::storage, ReuseStream::storage);
  set(Stream::vertex, ReuseStream::geometry);
  set(Stream::index, ReuseStream::geometry);
  set(Stream::texture, ReuseStream::texture);
  model.l1_fill = moved_by(pass.reuse.texture_l1, rates.l1_bytes, false).read;
  model.l2.read[at(Stream::texture)] = model.l1_fill;
  model.dram.read[at(Stream::texture)] = smaller(model.dram.read[at(Stream::texture)], model.l1_fill);
  T color_scale(1.0);
  if (rates.msaa_color_compression && shape.color_samples > 1.0)
    color_scale = T(shape.uncompressed_ratio + (1.0 - shape.uncompressed_ratio) / shape.color_samples);
  for (std::array<T, kStreamCount>* moved :
       {&model.dram.read, &model.dram.write, &model.l2.read, &model.l2.write})
    (*moved)[at(Stream::color)] *= color_scale;
  for (std::array<T, kStreamCount>* moved : {&model.dram.read, &model.dram.write}) {
    (*moved)[at(Stream::color)] *= rates.color_traffic_ratio;
    (*moved)[at(Stream::depth)] *= rates.depth_traffic_ratio;
  }
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

/// Vertices that binning writes and the tiles read back.
inline double binned_bytes(const PassCounters& c) { return 4.0 * static_cast<double>(c.vs.output_scalars); }

template <class T>
ChunkTraffic<T> chunk_traffic(const PassCounters& c, const TrafficModel<T>& model, const GpuRates<T>& rates) {
  ChunkTraffic<T> traffic;
  const StreamBytes asked = requested_bytes(c);
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    traffic.dram.read[i] = asked.read[i] * model.dram.read[i];
    traffic.dram.write[i] = asked.write[i] * model.dram.write[i];
    traffic.l2_bytes += asked.read[i] * model.l2.read[i] + asked.write[i] * model.l2.write[i];
  }
  traffic.storage_read_bytes = T(asked.read[at(Stream::storage)]);
  traffic.l1_fill_bytes = asked.read[at(Stream::texture)] * model.l1_fill;
  if (!rates.gs_on_chip) {  // rings in memory before and behind the stage (gpus section 4)
    const auto ring = static_cast<double>(c.gs.input_bytes + c.gs.output_bytes);
    traffic.dram.write[at(Stream::other)] += ring;
    traffic.dram.read[at(Stream::other)] += ring;
    traffic.l2_bytes += T(2.0 * ring);
  }
  if (rates.tile_based) {
    traffic.dram.write[at(Stream::other)] += binned_bytes(c);
    traffic.dram.read[at(Stream::other)] += binned_bytes(c);
  }
  return traffic;
}

}  // namespace hwsim
