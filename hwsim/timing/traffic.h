#pragma once
// Bytes that a pass moves through L2 and DRAM, from what its units asked for and the reuse distances that the
// trace keeps (docs/hardware_model.md, "Memory"): of the bytes that a stream requests in a pass, a cache of
// the GPU's size lets a part through, and each chunk's requests are charged that part.
#include <algorithm>
#include <array>
#include <cstddef>

#include "hwsim/gpu/gpu_rates.h"
#include "hwsim/timing/compression.h"
#include "hwsim/trace/work_trace.h"
#include "hwsim/units/unit_work.h"

namespace hwsim {

/// Bytes by stream; reals, because a miss ratio scales integer counts.
struct StreamBytes {
  std::array<double, kStreamCount> read{}, write{};
  double total_read() const;
  double total_write() const;
};

/// What does not depend on the GPU, once a pass.
struct PassShape {
  PassCounters sum;
  DepthMix depth_read{}, depth_write{};
  ColorMix color_read, color_write;
  double depth_tile_bytes = 0.0, color_tile_bytes = 0.0;  ///< raw; of the largest color target
};

/// What a chunk asks of memory, by stream, textures included.
StreamBytes requested_bytes(const PassCounters& chunk);

PassShape shape_of(const PassWork& pass);

/// Bytes moved for each byte requested.
template <class T>
struct TrafficModel {
  StreamBytesOf<T> dram, l2;
  /// The part that caches before L2 let through of what was asked for and moves compressed as DRAM sees it:
  /// behind it L2 decides.
  StreamBytesOf<T> reaches_l2;
  StreamBytesOf<T> tile_chunk;  ///< tile memory's loads and stores: DRAM bytes of each chunk
  double tile_px = 0.0;         ///< pixels of its screen tiles
  T l1_asked{1.0};              ///< texture bytes as whole lines that L1 is asked for
  T l1_fill{1.0};               ///< texture bytes beyond L1
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

/// Bytes that a block moves each time it comes in or leaves; whole tiles where the trace does not know.
template <class T>
T stay_bytes(const std::array<std::uint64_t, kCacheSizes>& bytes,
             const std::array<std::uint64_t, kCacheSizes>& stays, const T& cache_bytes, double tile_bytes) {
  const T count = moved_ratio(stays, 1, cache_bytes);
  if (!(count > T(0.0))) return T(tile_bytes);
  return moved_ratio(bytes, 1, cache_bytes) / count;
}

/// Compression of what moves between a cache and the memory behind it.
template <class T>
MovedRatio<T> kept_by(const PassShape& shape, const PassWork& pass, ReuseStream reuse, const MissCurve& curve,
                      const T& cache_bytes, const GpuRates<T>& r) {
  const bool color = reuse == ReuseStream::color;
  const double tile = color ? shape.color_tile_bytes : shape.depth_tile_bytes;
  const T read = stay_bytes(curve.read_bytes, curve.read_stays, cache_bytes, tile);
  const T write = stay_bytes(curve.write_bytes, curve.write_stays, cache_bytes, tile);
  if (!color)
    return {depth_kept_ratio(shape.depth_read, pass.depth_samples, tile, read, r),
            depth_kept_ratio(shape.depth_write, pass.depth_samples, tile, write, r)};
  if (pass.kind != PassKind::resolve)
    return {color_kept_ratio(shape.color_read, pass, read, r),
            color_kept_ratio(shape.color_write, pass, write, r)};
  const auto samples = static_cast<double>(std::max<std::uint64_t>(1, shape.sum.resolve.read_samples));
  const double sample_bytes = static_cast<double>(shape.sum.mem.color_read_bytes) / samples;
  return {
      T(sample_bytes > 0.0 ? multisample_ratio(shape.color_read, pass.raster_samples, sample_bytes, r) : 1.0),
      color_kept_ratio(shape.color_write, pass, write, r)};
}

/// Color or depth: a cache in the ROPs, and L2 behind it where they go through it. Tiles are compressed on
/// their way out of the ROPs' caches, so L2 and DRAM both see the compressed bytes.
template <class T>
void model_rop(const PassShape& shape, const PassWork& pass, ReuseStream reuse, const GpuRates<T>& r,
               TrafficModel<T>& model) {
  const bool color = reuse == ReuseStream::color;
  const std::size_t i = index_of(color ? Stream::color : Stream::depth);
  const bool cleared = color ? pass.color_cleared_before : pass.depth_cleared_before;
  const T& own_cache = color ? r.crop_cache_bytes : r.zrop_cache_bytes;
  const auto times = [](const MovedRatio<T>& a, const MovedRatio<T>& b) {
    return MovedRatio<T>{a.read * b.read, a.write * b.write};
  };
  const MissCurve& apart = pass.reuse.apart[index_of(reuse)];
  const MissCurve& behind = r.rop_through_l2 ? pass.reuse.shared[index_of(reuse)] : apart;
  const T last_cache = r.rop_through_l2 ? r.l2_bytes : T(own_cache + r.llc_bytes);
  const MovedRatio<T> kept = kept_by(shape, pass, reuse, behind, last_cache, r);
  const MovedRatio<T> dram = times(moved_by(behind, last_cache, cleared), kept);
  model.dram.read[i] = dram.read;
  model.dram.write[i] = dram.write;
  model.l2.read[i] = model.l2.write[i] = T(0.0);
  if (!r.rop_through_l2) return;
  const MovedRatio<T> l2 =
      times(moved_by(apart, own_cache, cleared), kept_by(shape, pass, reuse, apart, own_cache, r));
  model.l2.read[i] = larger(l2.read, dram.read);
  model.l2.write[i] = larger(l2.write, dram.write);
  model.reaches_l2.read[i] = model.l2.read[i] / larger(kept.read, T(1e-9));
  model.reaches_l2.write[i] = model.l2.write[i] / larger(kept.write, T(1e-9));
}

constexpr bool draws(PassKind kind) { return kind == PassKind::draw || kind == PassKind::full_screen; }

/// A screen tile is halved until the color of its pixels fits.
template <class T>
double screen_tile_px(const PassWork& pass, const GpuRates<T>& r) {
  constexpr double kSmallestPx = 16.0;
  double px = r.tile_px, px_bytes = 0.0;
  for (const ColorTargetWork& target : pass.color_targets)
    px_bytes += static_cast<double>(target.samples) * static_cast<double>(info(target.format).bytes);
  while (px > kSmallestPx && r.tile_memory_bytes < T(px * px_bytes)) px /= 2.0;
  return px;
}

/// GPUs with tile memory: what a pass draws on is loaded where it goes on with older contents, and stored
/// where somebody needs it; a tile that the pass does not touch is stored if it was cleared. A resolve of
/// what was just drawn reads tile memory.
template <class T>
void model_tile_memory(const PassShape& shape, const PassWork& pass, const GpuRates<T>& r,
                       TrafficModel<T>& model) {
  model.tile_px = screen_tile_px(pass, r);
  for (const Stream stream : {Stream::color, Stream::depth}) {
    const std::size_t i = index_of(stream);
    model.l2.read[i] = model.l2.write[i] = T(0.0);
    if (draws(pass.kind)) model.dram.read[i] = model.dram.write[i] = T(0.0);
    if (pass.source_in_tile) model.dram.read[i] = T(0.0);
  }
  if (!draws(pass.kind) || pass.chunks.empty()) return;
  const auto chunks = static_cast<double>(pass.chunks.size());
  const double all_px = static_cast<double>(pass.width_px) * pass.height_px;
  const auto touched_px = [&](std::uint64_t tiles, double targets) {
    return std::min(all_px, kTilePixels * static_cast<double>(tiles) / targets);
  };
  const auto add = [&](Stream stream, double touched, bool cleared, bool loaded, bool kept, double px_bytes,
                       const T& read_ratio, const T& write_ratio) {
    if (loaded && !cleared)
      model.tile_chunk.read[index_of(stream)] += touched * px_bytes / chunks * read_ratio;
    if (kept)
      model.tile_chunk.write[index_of(stream)] +=
          (cleared ? all_px : touched) * px_bytes / chunks * write_ratio;
  };
  const auto targets = static_cast<double>(pass.color_targets.size());
  for (const ColorTargetWork& t : pass.color_targets) {
    const auto bytes = static_cast<double>(info(t.format).bytes);
    const auto ratio = [&](const ColorMix& mix) {
      return t.samples > 1 ? T(multisample_ratio(mix, t.samples, bytes, r)) : r.color_delta_ratio;
    };
    add(Stream::color, touched_px(shape.sum.crop.first_touched_tiles, targets), pass.color_cleared_before,
        t.loaded, t.kept, t.samples * bytes, ratio(shape.color_read), ratio(shape.color_write));
  }
  if (pass.depth_format == Format::none) return;
  const double tile = shape.depth_tile_bytes;
  const bool changed = pass.depth_cleared_before || shape.sum.zrop.written_samples > 0;
  add(Stream::depth, touched_px(shape.sum.zrop.first_touched_tiles, 1.0), pass.depth_cleared_before,
      pass.depth_loaded, pass.depth_kept && changed, tile / kTilePixels,
      depth_kept_ratio(shape.depth_read, pass.depth_samples, tile, T(tile), r),
      depth_kept_ratio(shape.depth_write, pass.depth_samples, tile, T(tile), r));
}

template <class T>
TrafficModel<T> model_traffic(const PassShape& shape, const PassWork& pass, const GpuRates<T>& rates) {
  TrafficModel<T> model;
  model.dram.read.fill(T(1.0));
  model.dram.write.fill(T(1.0));
  model.l2 = model.reaches_l2 = model.dram;
  model_rop(shape, pass, ReuseStream::color, rates, model);
  model_rop(shape, pass, ReuseStream::depth, rates, model);
  if (rates.tile_based) model_tile_memory(shape, pass, rates, model);
  const auto& in_l2 = rates.rop_through_l2 && !rates.tile_based ? pass.reuse.shared : pass.reuse.apart;
  // Lines move whole: accesses to parts of lines ask L2 for more than they use.
  const auto set = [&](Stream stream, ReuseStream reuse) {
    const MissCurve& curve = in_l2[index_of(reuse)];
    const MovedRatio<T> moved = moved_by(curve, rates.l2_bytes, false);
    const MovedRatio<T> lines = moved_by(curve, T(kSmallestCacheBytes), false);
    const std::size_t i = index_of(stream);
    model.dram.read[i] = moved.read;
    model.dram.write[i] = moved.write;
    model.l2.read[i] = model.reaches_l2.read[i] = larger(T(1.0), lines.read);
    model.l2.write[i] = model.reaches_l2.write[i] = larger(T(1.0), lines.write);
  };
  set(Stream::storage, ReuseStream::storage);
  set(Stream::vertex, ReuseStream::geometry);
  set(Stream::index, ReuseStream::geometry);
  set(Stream::texture, ReuseStream::texture);
  model.l1_asked = larger(T(1.0), moved_by(pass.reuse.texture_l1, T(kSmallestCacheBytes), false).read);
  model.l1_fill = moved_by(pass.reuse.texture_l1, rates.l1_bytes, false).read;
  model.l2.read[index_of(Stream::texture)] = model.reaches_l2.read[index_of(Stream::texture)] = model.l1_fill;
  model.dram.read[index_of(Stream::texture)] =
      smaller(model.dram.read[index_of(Stream::texture)], model.l1_fill);
  return model;
}

/// Rings in memory before and behind geometry shaders, each written and read
/// (docs/hardware_sources.md#geometry).
inline double ring_bytes(const PassCounters& c, bool gs_on_chip) {
  return gs_on_chip ? 0.0 : static_cast<double>(c.gs.input_bytes + c.gs.output_bytes);
}
/// What binning writes and the tiles read back: vertices once, as L2 keeps what neighboring tiles share, and
/// an entry for each triangle in each tile's list. A triangle of one 8x8 tile lies in one tile; of larger
/// ones, as many 8x8 tiles as fit share an entry.
template <class T>
T binned_bytes(const PassCounters& c, double tile_px, const GpuRates<T>& r) {
  const auto drawn = static_cast<double>(c.setup.out_primitives);
  const double further = std::max(0.0, static_cast<double>(c.raster.visited_tiles) - drawn);
  return 4.0 * static_cast<double>(c.vs.output_scalars) +
         r.tile_list_entry_bytes * (drawn + further * kTilePixels / tile_px);
}

template <class T>
ChunkTraffic<T> chunk_traffic(const PassCounters& c, const TrafficModel<T>& model, const GpuRates<T>& rates) {
  ChunkTraffic<T> traffic;
  const StreamBytes asked = requested_bytes(c);
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    traffic.dram.read[i] = asked.read[i] * model.dram.read[i];
    traffic.dram.write[i] = asked.write[i] * model.dram.write[i];
    traffic.l2_bytes += asked.read[i] * model.l2.read[i] + asked.write[i] * model.l2.write[i];
  }
  traffic.storage_read_bytes =
      asked.read[index_of(Stream::storage)] * model.l2.read[index_of(Stream::storage)];
  traffic.l1_fill_bytes = asked.read[index_of(Stream::texture)] * model.l1_fill;
  const double ring = ring_bytes(c, rates.gs_on_chip);
  traffic.dram.write[index_of(Stream::other)] += ring;
  traffic.dram.read[index_of(Stream::other)] += ring;
  traffic.l2_bytes += T(2.0 * ring);
  if (rates.tile_based) {
    traffic.dram += model.tile_chunk;
    const T binned = binned_bytes(c, model.tile_px, rates);
    traffic.dram.write[index_of(Stream::other)] += binned;
    traffic.dram.read[index_of(Stream::other)] += binned;
  }
  return traffic;
}

}  // namespace hwsim
