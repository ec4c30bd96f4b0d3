#pragma once
// Bytes of compressed depth tiles and color pixels, from their counted forms (docs/compression.md).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "hwsim/gpu/gpu_rates.h"
#include "hwsim/trace/work_trace.h"
#include "hwsim/units/unit_work.h"

namespace hwsim {

/// In the order of the counters: clear, one plane, two, four, offsets of 6 and of 14 bits, raw.
inline constexpr std::size_t kDepthForms = 7;
using DepthMix = std::array<double, kDepthForms>;  ///< parts of the tiles; all zero: not counted

DepthMix depth_reads(const ZropCounters& counters, bool without_cleared);
DepthMix depth_writes(const ZropCounters& counters);

/// Parts of the pixels of multisampled tiles.
struct ColorMix {
  bool counted = false;
  double single = 0.0, twice = 0.0;    ///< with one color, with two
  double in_8px = 0.0, in_16px = 0.0;  ///< in groups of 4x2 and 4x4 pixels that have one color each
};
ColorMix color_reads(const CropCounters& counters);
ColorMix color_writes(const CropCounters& counters);

/// Part of the pixels that lie in blocks of `block_px` pixels with one color each: between the sizes counted,
/// linear in the logarithm of the size.
double pixels_in_single_blocks(const ColorMix& mix, double block_px);

/// Bytes of a tile in each form, in whole granules; at least as good as raw.
template <class T>
DepthMix depth_tile_bytes(int samples, double raw_bytes, const GpuRates<T>& r) {
  constexpr double kPlaneBytes = 12.0, kRangeBytes = 8.0;  // base and two slopes; nearest and farthest value
  const double values = kTilePixels * samples, granule = r.compression_granule_bytes;
  const auto stored = [&](bool has, double bytes) {
    return has ? std::min(raw_bytes, std::ceil(bytes / granule) * granule) : raw_bytes;
  };
  const auto planes = [&](int slots, double index_bits) {
    return stored(r.depth_plane_slots >= slots, slots * kPlaneBytes + values * index_bits / 8.0);
  };
  const auto offsets = [&](double bits) {
    return stored(r.depth_offset_forms, kRangeBytes + values * (1.0 + bits) / 8.0);
  };
  return {r.fast_clear_depth ? 0.0 : raw_bytes,
          planes(1, 0.0),
          planes(2, 1.0),
          planes(4, 2.0),
          offsets(6.0),
          offsets(14.0),
          raw_bytes};
}

/// Bytes that stays of depth tiles move / bytes that they would without compression, of which `stay_bytes` a
/// stay. A compressed tile moves whole, but never more than what was asked of its samples.
template <class T>
T depth_kept_ratio(const DepthMix& mix, int samples, double raw_bytes, const T& stay_bytes,
                   const GpuRates<T>& r) {
  const DepthMix bytes = depth_tile_bytes(samples, raw_bytes, r);
  double all = 0.0;
  T sum(0.0);
  for (std::size_t form = 0; form < kDepthForms; ++form) {
    all += mix[form];
    sum += mix[form] * smaller(T(bytes[form]), stay_bytes);
  }
  return all > 0.0 && stay_bytes > T(0.0) ? T(sum / (all * stay_bytes)) : T(1.0);
}

/// The same of one multisampled target. A mask that says which color a sample has takes 8 bits a pixel up to
/// 4 samples, 32 bits at 8 (FMASK [MESA-r6], MCS [MESA-isl]) and 64 at 16.
template <class T>
double multisample_ratio(const ColorMix& mix, int samples, double sample_bytes, const GpuRates<T>& r) {
  if (!mix.counted || !r.msaa_color_compression) return 1.0;
  if (r.msaa_color_block_bytes > 0) {
    const double single = pixels_in_single_blocks(mix, r.msaa_color_block_bytes / (samples * sample_bytes));
    return single / samples + (1.0 - single);
  }
  const double mask_bytes = samples <= 4 ? 1.0 : 0.5 * samples;
  const double colors = (mix.single + 2.0 * mix.twice) / samples + (1.0 - mix.single - mix.twice);
  return std::min(1.0, colors + mask_bytes / (samples * sample_bytes));
}

/// What a stay moves at least, of the bytes asked of it: a granule.
template <class T>
T at_least_a_granule(const T& ratio, const T& stay_bytes, const GpuRates<T>& r) {
  if (!(stay_bytes > T(0.0))) return ratio;
  return larger(ratio, smaller(T(1.0), T(static_cast<double>(r.compression_granule_bytes) / stay_bytes)));
}

/// Bytes of all color targets together.
template <class T>
T color_kept_ratio(const ColorMix& mix, const PassWork& pass, const T& stay_bytes, const GpuRates<T>& r) {
  double all = 0.0;
  T sum(0.0);
  for (const ColorTargetWork& target : pass.color_targets) {
    const auto sample_bytes = static_cast<double>(info(target.format).bytes);
    const double bytes = target.samples * sample_bytes;
    all += bytes;
    sum += bytes * (target.samples > 1 ? T(multisample_ratio(mix, target.samples, sample_bytes, r))
                                       : r.color_delta_ratio);
  }
  return all > 0.0 ? at_least_a_granule(T(sum / all), stay_bytes, r) : T(1.0);
}

}  // namespace hwsim
