#pragma once
// What the timing engines use: costs in nanoseconds an item, derived from a GpuConfig after every override.
// No file can set them, so doubling a base value cannot leave a stale product behind. T is double, or a Jet
// while fitting.

#include <array>
#include <cmath>
#include <cstddef>

#include "hwsim/gpu/gpu_config.h"
#include "hwsim/trace/format.h"

namespace hwsim {

inline constexpr int kRateClassCount = 7;

template <class T>
struct GpuRates {
  T draw_ns, state_change_ns, index_ns;
  T culled_triangle_ns, drawn_triangle_ns;
  T raster_px_ns, raster_sample_ns, raster_tile_ns, hiz_px_ns;
  T zrop_sample_ns;
  T vliw_word_ns;  ///< zero where words are not of five slots: then the average fill alone says it
  T shader_cores, subgroups_max, registers, group_memory_bytes, alu_latency_ns, tex_latency_ns, l2_latency_ns,
      dram_latency_ns;
  T alu_lane_op_ns, sfu_lane_op_ns, interp_scalar_ns, memory_word_ns, group_memory_word_ns, atomic_ns,
      same_address_atomic_ns, gs_output_word_ns;
  T bilinear_probe_ns, fetch_64bit_cost, fetch_128bit_cost, l1_fill_byte_ns, l1_bytes;
  std::array<T, kRateClassCount> color_px_ns,
      blended_px_ns;  ///< docs/hardware_sources.md#rules, 1: min(raster, export, ROP)
  std::array<T, kRateClassCount> color_sample_ns;  ///< multisample writes, the ROPs alone
  T resolve_sample_ns;
  T l2_byte_ns, dram_byte_ns, dram_turn_ns;
  T unit_lines;  ///< that a fixed-function unit has on their way
  T l2_bytes;    ///< with the last-level cache behind it
  T crop_cache_bytes, zrop_cache_bytes, llc_bytes;
  T color_delta_ratio, tile_memory_bytes, tile_list_entry_bytes;
  T clear_color_tile_bytes, clear_depth_tile_bytes;
  T pass_overhead_ns, roofline_exponent;
  int subgroup_size, queue_packets;
  int dram_write_lines;  ///< that a channel writes together
  int compression_granule_bytes, msaa_color_block_bytes, depth_plane_slots, tile_px;
  bool vliw;  ///< special functions take a slot of the words
  bool interp_on_alu, crop_compressible_at_pixel_rate, msaa_color_compression, rop_through_l2, tile_based;
  bool fast_clear_color, fast_clear_depth, gs_on_chip, depth_offset_forms;
};

/// std::min and std::max return references to arguments and do not know Jets' comparisons in constant
/// expressions; these return values.
template <class T>
T smaller(const T& a, const T& b) {
  return b < a ? b : a;
}
template <class T>
T larger(const T& a, const T& b) {
  return a < b ? b : a;
}

/// Pixels a clock that leave the ROPs, by class of format.
template <class T>
std::array<T, kRateClassCount> rop_ratios(const GpuValues<T>& c) {
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

template <class T>
T export_ratio(const GpuValues<T>& c, RateClass k) {
  if (k == RateClass::half4_64 || k == RateClass::bits64) return c.export_64bit_ratio;
  return k == RateClass::float4_128 ? c.export_128bit_ratio : T(1.0);
}

template <class T>
T blend_ratio(const GpuValues<T>& c, RateClass k) {
  if (k == RateClass::bits32 || k == RateClass::srgb32) return c.blend_rgba8_ratio;
  return k == RateClass::float4_128 ? c.blend_128bit_ratio : c.blend_other_ratio;
}

template <class T>
void derive_color(const GpuValues<T>& c, const T& clk_ns, GpuRates<T>& r) {
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
}

template <class T>
void derive_shader(const GpuValues<T>& c, const T& clk_ns, GpuRates<T>& r) {
  const T shader_clk_ns = clk_ns / c.shader_clock_ratio;
  const T lanes = c.shader_cores * c.fp32_lanes_per_core * c.vliw_fill_slots / c.vliw_slots;
  constexpr double kCountedVliwSlots = 5.0, kRegisterBytes = 4.0;
  r.vliw = c.vliw_slots > T(1.0);
  r.vliw_word_ns = T(0.0);
  if (!(c.vliw_slots < T(kCountedVliwSlots)) && !(T(kCountedVliwSlots) < c.vliw_slots))
    r.vliw_word_ns =
        shader_clk_ns * c.vliw_slots / (c.shader_cores * c.fp32_lanes_per_core * c.alu_efficiency_ratio);
  r.shader_cores = c.shader_cores;
  r.subgroups_max = c.subgroups_per_core_max;
  r.group_memory_bytes = c.group_memory_kib_per_core * 1024.0;
  r.registers = c.registers_kib_per_core * (1024.0 / kRegisterBytes);
  r.alu_latency_ns = c.alu_latency_cycles * shader_clk_ns;
  r.tex_latency_ns = c.tex_latency_cycles * clk_ns;
  r.l2_latency_ns = c.l2_latency_cycles * clk_ns;
  r.dram_latency_ns = c.dram_latency_cycles * clk_ns;
  r.alu_lane_op_ns = shader_clk_ns / (lanes * c.alu_efficiency_ratio);
  r.sfu_lane_op_ns = shader_clk_ns / (c.shader_cores * c.sfu_lanes_per_core);
  r.interp_scalar_ns = shader_clk_ns / (c.shader_cores * c.interp_scalars_per_core_clk);
  r.interp_on_alu = c.interp_on_alu;
  r.memory_word_ns = clk_ns / (c.shader_cores * c.load_words_per_core_clk);
  r.group_memory_word_ns = clk_ns / (c.shader_cores * c.group_memory_words_per_core_clk);
  r.atomic_ns = clk_ns / c.atomic_lane_ops_per_clk;
  r.same_address_atomic_ns = clk_ns / c.atomic_same_address_ops_per_clk;
  r.gs_output_word_ns = clk_ns / (c.shader_cores * c.gs_output_words_per_core_clk);
  r.gs_on_chip = c.gs_on_chip;
  r.subgroup_size = c.subgroup_size;
}

template <class T>
void derive_geometry(const GpuValues<T>& c, const T& clk_ns, GpuRates<T>& r) {
  r.draw_ns = clk_ns * c.draw_cycles;
  r.state_change_ns = clk_ns * c.state_change_cycles;
  const T fastest = larger(c.setup_culled_triangles_per_clk, c.setup_drawn_triangles_per_clk);
  r.index_ns = clk_ns / (c.ia_indices_per_clk > T(0.0) ? c.ia_indices_per_clk : T(fastest * 3.0));
  r.culled_triangle_ns = clk_ns / c.setup_culled_triangles_per_clk;
  r.drawn_triangle_ns = clk_ns / c.setup_drawn_triangles_per_clk;
  r.raster_px_ns = clk_ns / (c.raster_engines * c.raster_px_per_engine_clk);
  r.raster_sample_ns = clk_ns / c.raster_samples_per_clk;
  r.raster_tile_ns = clk_ns / (c.raster_engines * c.raster_tiles_per_engine_clk);
  r.hiz_px_ns = clk_ns / c.hiz_px_per_clk;
  r.zrop_sample_ns = clk_ns / (c.crop_units * c.zrop_samples_per_unit_clk * c.zrop_efficiency_ratio);
}

template <class T>
void derive_texture(const GpuValues<T>& c, const T& clk_ns, GpuRates<T>& r) {
  const T probe_ns = clk_ns / (c.tex_bilinear_per_clk * c.tex_efficiency_ratio);
  r.bilinear_probe_ns = probe_ns;
  r.fetch_64bit_cost = 1.0 / c.tex_64bit_ratio;
  r.fetch_128bit_cost = 1.0 / c.tex_128bit_ratio;
  r.l1_fill_byte_ns = clk_ns / (c.shader_cores * c.l1_fill_bytes_per_core_clk);
  r.l1_bytes = c.l1_size_kib * 1024.0;
  r.resolve_sample_ns = c.resolve_samples_per_clk > T(0.0) ? T(clk_ns / c.resolve_samples_per_clk) : probe_ns;
}

template <class T>
void derive_memory(const GpuValues<T>& c, const T& clk_ns, GpuRates<T>& r) {
  constexpr double kKib = 1024.0;
  r.l2_byte_ns = clk_ns / c.l2_bytes_per_clk;
  r.dram_byte_ns = 1.0 / (c.dram_bandwidth_gb_s * c.dram_efficiency_ratio * (1.0 - c.dram_cpu_share_ratio));
  r.dram_turn_ns = T(c.dram_turn_ns) / static_cast<double>(c.dram_channels);
  r.dram_write_lines = c.dram_write_lines;
  r.unit_lines = c.unit_lines_max;
  r.l2_bytes = (c.l2_size_kib + c.llc_size_kib) * kKib;
  r.crop_cache_bytes = c.crop_cache_kib * kKib;
  r.zrop_cache_bytes = c.zrop_cache_kib * kKib;
  r.llc_bytes = c.llc_size_kib * kKib;
  r.compression_granule_bytes = c.compression_granule_bytes;
  r.msaa_color_block_bytes = c.msaa_color_block_bytes;
  r.color_delta_ratio = c.color_delta_ratio;
  r.depth_plane_slots = c.depth_plane_slots;
  r.depth_offset_forms = c.depth_offset_forms;
  r.tile_px = c.tile_px;
  r.tile_list_entry_bytes = c.tile_list_entry_bytes;
  r.tile_memory_bytes = c.tile_memory_kib * kKib;
  r.clear_color_tile_bytes = c.fast_clear_color_bytes_per_tile;
  r.clear_depth_tile_bytes = c.fast_clear_depth_bytes_per_tile;
  r.rop_through_l2 = c.rop_through_l2;
  r.tile_based = c.tile_based;
  r.msaa_color_compression = c.msaa_color_compression;
  r.crop_compressible_at_pixel_rate = c.crop_compressible_at_pixel_rate;
  r.fast_clear_color = c.fast_clear_color;
  r.fast_clear_depth = c.fast_clear_depth;
}

template <class T>
GpuRates<T> derive_rates(const GpuValues<T>& c) {
  GpuRates<T> r;
  const T clk_ns = 1000.0 / c.core_clock_mhz;
  derive_geometry(c, clk_ns, r);
  derive_shader(c, clk_ns, r);
  derive_texture(c, clk_ns, r);
  derive_color(c, clk_ns, r);
  derive_memory(c, clk_ns, r);
  r.pass_overhead_ns = c.pass_overhead_us * 1000.0;
  r.roofline_exponent = c.roofline_exponent;
  r.queue_packets = c.queue_packets;
  return r;
}

}  // namespace hwsim
