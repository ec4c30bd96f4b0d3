#pragma once
// Color units of the ROPs: writes, blending, their caches, clears and compression of color.
#include <algorithm>
#include <array>

#include "hwsim/base/units_of_measure.h"
#include "hwsim/config/key.h"
#include "hwsim/trace/format.h"
#include "hwsim/units/ranges.h"
#include "hwsim/units/unit_work.h"

namespace hwsim {

inline constexpr int kRateClassCount = 7;

/// Pixels a clock that leave the ROPs, by class of format.
template <class Gpu, class T = typename Gpu::Scalar>
std::array<T, kRateClassCount> rop_ratios(const Gpu& c) {
  std::array<T, kRateClassCount> ratio;
  ratio.fill(T(1.0));
  const auto of = [&ratio](RateClass k) -> T& { return ratio[static_cast<std::size_t>(k)]; };
  of(RateClass::srgb32) = c.crop_srgb32_ratio;
  of(RateClass::half4_64) = c.crop_half4_64_ratio;
  of(RateClass::float1_32) = c.crop_float1_32_ratio;
  of(RateClass::bits64) = c.crop_bits64_ratio;
  of(RateClass::float4_128) = c.crop_float4_128_ratio;
  return ratio;
}

template <class Gpu, class T = typename Gpu::Scalar>
T export_ratio(const Gpu& c, RateClass k) {
  if (k == RateClass::half4_64 || k == RateClass::bits64) return c.export_64bit_ratio;
  return k == RateClass::float4_128 ? c.export_128bit_ratio : T(1.0);
}

template <class Gpu, class T = typename Gpu::Scalar>
T blend_ratio(const Gpu& c, RateClass k) {
  if (k == RateClass::bits32 || k == RateClass::srgb32) return c.blend_rgba8_ratio;
  return k == RateClass::float4_128 ? c.blend_128bit_ratio : c.blend_other_ratio;
}

}  // namespace hwsim

namespace hwsim::units {

/// Color units of the ROPs.
struct ColorRop {
  static constexpr UnitInfo kInfo = {
      "crop", UnitPlace::rops, set_of(Stream::color, Stream::other),
      "sum over the targets of max(pixels / pixel rate, samples / sample rate), see below"};

  template <class T>
  struct Values {
    T export_px_per_clk{0.0};
    T export_64bit_ratio{0.5};
    T export_128bit_ratio{0.25};
    T crop_units{0.0};
    T crop_srgb32_ratio{1.0};
    T crop_half4_64_ratio{0.5};
    T crop_float1_32_ratio{1.0};
    T crop_bits64_ratio{0.5};
    T crop_float4_128_ratio{0.25};
    T crop_efficiency_ratio{1.0};
    T blend_rgba8_ratio{1.0};
    T blend_other_ratio{0.5};
    T blend_128bit_ratio{0.25};
    T crop_msaa_samples_per_unit_clk{1.0};
    bool crop_compressible_at_pixel_rate = true;
    T crop_cache_kib{16.0};
    bool fast_clear_color = true;
    T fast_clear_color_bytes_per_tile{0.5};
    bool msaa_color_compression = true;
    int msaa_color_block_bytes = 0;
    T color_delta_ratio{1.0};
    bool shader_read_expands_color = false;
  };

  template <class V, class T>
  static void describe(V& v, Values<T>& c) {
    v.key({"export_px_per_clk", kRateLow, kRateHigh, kRequired | kFaster,
           "pixels from shader cores to ROPs, 32-bit color"},
          c.export_px_per_clk);
    v.key({"export_64bit_ratio", kRatioLow, 1, kFaster, "of that, 64-bit color"}, c.export_64bit_ratio);
    v.key({"export_128bit_ratio", kRatioLow, 1, kFaster, "of that, 128-bit color"}, c.export_128bit_ratio);
    v.key({"crop_units", 1, 1e5, kRequired | kFaster | kWhole, "ROPs; each writes one 32-bit pixel a clock"},
          c.crop_units);
    v.key({"crop_srgb32_ratio", kRatioLow, 1, kFaster, "pixels a clock and ROP, 8-bit sRGB"},
          c.crop_srgb32_ratio);
    v.key({"crop_half4_64_ratio", kRatioLow, 1, kFaster, "pixels a clock and ROP, 4 x 16 bit"},
          c.crop_half4_64_ratio);
    v.key({"crop_float1_32_ratio", kRatioLow, 1, kFaster, "pixels a clock and ROP, 32-bit float"},
          c.crop_float1_32_ratio);
    v.key({"crop_bits64_ratio", kRatioLow, 1, kFaster, "pixels a clock and ROP, 2 x 32 bit"},
          c.crop_bits64_ratio);
    v.key({"crop_float4_128_ratio", kRatioLow, 1, kFaster, "pixels a clock and ROP, 4 x 32 bit"},
          c.crop_float4_128_ratio);
    v.key({"crop_efficiency_ratio", kRatioLow, 1, kFit | kFaster, "of the ROPs' rate, reached"},
          c.crop_efficiency_ratio);
    v.key(
        {"blend_rgba8_ratio", kRatioLow, 1, kFaster, "speed of blending 4 x 8 bit, relative to plain writes"},
        c.blend_rgba8_ratio);
    v.key({"blend_other_ratio", kRatioLow, 1, kFaster,
           "speed of blending other formats up to 64 bit, relative"},
          c.blend_other_ratio);
    v.key({"blend_128bit_ratio", kRatioLow, 1, kFaster, "speed of blending 128 bit, relative"},
          c.blend_128bit_ratio);
    v.key({"crop_msaa_samples_per_unit_clk", kRateLow, kRateHigh, kFaster,
           "multisample color, a clock and ROP"},
          c.crop_msaa_samples_per_unit_clk);
    v.key({"crop_compressible_at_pixel_rate", 0, 0, kFaster,
           "a pixel whose samples share one color costs the ROP one pixel, not its samples"},
          c.crop_compressible_at_pixel_rate);
    v.key({"crop_cache_kib", 0, kKibHigh, kFaster, "color caches of the chip, before L2 or instead of it"},
          c.crop_cache_kib);
    v.key({"fast_clear_color", 0, 0, kFaster, "clears of color write a tile table only"}, c.fast_clear_color);
    v.key({"fast_clear_color_bytes_per_tile", 0, 1e4, kSlower, "table bytes of an 8x8 color tile"},
          c.fast_clear_color_bytes_per_tile);
    v.key({"msaa_color_compression", 0, 0, kFaster, "samples of a pixel that share a color move once"},
          c.msaa_color_compression);
    v.key(
        {"msaa_color_block_bytes", 0, 65536, kNeither,
         "samples compressed together, all pixels of one color or none; 0: each pixel by itself, with a mask "
         "that says which color a sample has"},
        c.msaa_color_block_bytes);
    v.key({"color_delta_ratio", kRatioLow, 1, kFit | kSlower,
           "bytes of single-sample color moved / uncompressed bytes"},
          c.color_delta_ratio);
    v.key({"shader_read_expands_color", 0, 0, kSlower,
           "multisampled color that was drawn is decompressed in place before a shader reads it"},
          c.shader_read_expands_color);
  }

  template <class T>
  struct Rates {
    /// Times of a pixel: the smallest of the rates of raster, export and ROP (docs/hardware_sources.md#rules,
    /// 1).
    std::array<T, kRateClassCount> color_px_ns, blended_px_ns;
    std::array<T, kRateClassCount> color_sample_ns;  ///< multisample writes, the ROPs alone
    T crop_cache_bytes, clear_color_tile_bytes, color_delta_ratio;
    int msaa_color_block_bytes;
    bool crop_compressible_at_pixel_rate, msaa_color_compression, fast_clear_color, shader_read_expands_color;
  };

  template <class Gpu, class T, class R>
  static void derive(const Gpu& c, const T& clk_ns, R& r) {
    const std::array<T, kRateClassCount> ratios = rop_ratios(c);
    const T raster_px = c.raster_engines * c.raster_px_per_engine_clk;
    for (std::size_t i = 0; i < kRateClassCount; ++i) {
      const auto k = static_cast<RateClass>(i);
      const T rop_px = c.crop_units * ratios[i];
      const T px = smaller(smaller(raster_px, T(c.export_px_per_clk * export_ratio(c, k))), rop_px);
      r.color_px_ns[i] = clk_ns / (px * c.crop_efficiency_ratio);
      r.blended_px_ns[i] = r.color_px_ns[i] / blend_ratio(c, k);
      r.color_sample_ns[i] = clk_ns / (rop_px * c.crop_msaa_samples_per_unit_clk * c.crop_efficiency_ratio);
    }
    r.crop_cache_bytes = c.crop_cache_kib * kBytesPerKib;
    r.clear_color_tile_bytes = c.fast_clear_color_bytes_per_tile;
    r.color_delta_ratio = c.color_delta_ratio;
    r.msaa_color_block_bytes = c.msaa_color_block_bytes;
    r.crop_compressible_at_pixel_rate = c.crop_compressible_at_pixel_rate;
    r.msaa_color_compression = c.msaa_color_compression;
    r.shader_read_expands_color = c.shader_read_expands_color;
    r.fast_clear_color = c.fast_clear_color;
  }

  template <class T, class R>
  static T service_ns(const UnitWork<T>& w, const R& r) {
    double all_samples = 0.0;
    for (const ColorTargetWork& target : w.pass.color_targets) all_samples += target.samples;
    T sum(0.0);
    for (const ColorTargetWork& target : w.pass.color_targets) {
      const auto k = static_cast<std::size_t>(info(target.format).rate_class);
      if (k < static_cast<std::size_t>(RateClass::depth)) sum += target_ns(w, target, k, all_samples, r);
    }
    return sum;
  }

 private:
  /// max(pixels / pixel rate, uncompressed samples / sample rate) (docs/hardware_sources.md#rops): each
  /// target has its share of the fragments and of the samples written.
  template <class T, class R>
  static T target_ns(const UnitWork<T>& w, const ColorTargetWork& target, std::size_t k, double all_samples,
                     const R& r) {
    const CropCounters& c = w.counters.crop;
    const auto targets = static_cast<double>(w.pass.color_targets.size());
    const double px = static_cast<double>(c.exported_fragments) / targets;
    const bool blended = target.blended && c.blended_samples > 0;
    const T& px_ns = blended ? r.blended_px_ns[k] : r.color_px_ns[k];
    const T cost = px * px_ns;
    if (target.samples <= 1) return cost;
    const double written = static_cast<double>(c.written_samples) * target.samples / all_samples;
    const double single = static_cast<double>(c.single_color_fragments) / targets * target.samples;
    const double samples = r.crop_compressible_at_pixel_rate ? std::max(0.0, written - single) : written;
    return larger(cost, T(samples * r.color_sample_ns[k] * (px_ns / r.color_px_ns[k])));
  }
};

}  // namespace hwsim::units
