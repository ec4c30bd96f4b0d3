#pragma once
// Every key of a GPU file, once. Ranges are wide on purpose: any positive value must work in a what-if; only
// the sign, the order of magnitude and ratios above one are refused.
#include "hwsim/config/key.h"
#include "hwsim/gpu/gpu_config.h"

namespace hwsim {

inline constexpr double kRateLow = 1e-3;  // items per clock
inline constexpr double kRateHigh = 1e6;
inline constexpr double kRatioLow =
    1e-3;  // a unit that is never fed is not a ratio of zero: leave the work out
inline constexpr double kKibHigh = 4.0 * 1024 * 1024;

template <class V, class T>
void describe_clocks(V& v, GpuValues<T>& c) {
  v.key({"core_clock_mhz", 1, 1e5, kRequired | kFit | kFaster,
         "clock of everything but DRAM and the shader lanes"},
        c.core_clock_mhz);
  v.key({"shader_clock_ratio", 0.1, 10, kFaster,
         "shader lanes' clock over the core clock (2 on Fermi: the hot clock)"},
        c.shader_clock_ratio);
}

template <class V, class T>
void describe_shader(V& v, GpuValues<T>& c) {
  v.key({"shader_cores", 1, 1e5, kRequired | kFaster | kWhole,
         "SM, SIMD engine, compute unit, EU: what runs a subgroup"},
        c.shader_cores);
  v.key({"fp32_lanes_per_core", kRateLow, 1e5, kRequired | kFaster,
         "32-bit multiply-adds a shader clock and core"},
        c.fp32_lanes_per_core);
  v.key(
      {"sfu_lanes_per_core", kRateLow, 1e5, kRequired | kFaster, "special functions a shader clock and core"},
      c.sfu_lanes_per_core);
  v.key({"subgroup_size", 8, 64, kNeither, "lanes that run in lock step: 8, 16, 32 or 64"}, c.subgroup_size);
  v.key({"vliw_slots", 1, 16, kSlower, "operations of an instruction word; 1 for scalar lanes"},
        c.vliw_slots);
  v.key({"vliw_fill_slots", 0.1, 16, kFit | kFaster, "of these, filled on average"}, c.vliw_fill_slots);
  v.key({"alu_efficiency_ratio", kRatioLow, 1, kFit | kFaster, "issue slots that shaders can use"},
        c.alu_efficiency_ratio);
  v.key({"interp_scalars_per_core_clk", kRateLow, kRateHigh, kRequired | kFaster,
         "attribute scalars interpolated a shader clock and core"},
        c.interp_scalars_per_core_clk);
  v.key({"interp_on_alu", 0, 0, kNeither,
         "interpolation takes issue slots of the lanes, not of the special functions"},
        c.interp_on_alu);
  v.key({"registers_kib_per_core", 1, kKibHigh, kFaster,
         "register file: with the shader's registers it bounds the resident subgroups"},
        c.registers_kib_per_core);
  v.key({"group_memory_kib_per_core", 1, kKibHigh, kFaster,
         "group memory: what compute groups reserve of it bounds the resident subgroups, too"},
        c.group_memory_kib_per_core);
  v.key({"subgroups_per_core_max", 1, 4096, kFaster, "resident subgroups whatever they need"},
        c.subgroups_per_core_max);
  v.key({"alu_latency_cycles", 1, 1e4, kSlower, "shader clocks from an operation to one that waits for it"},
        c.alu_latency_cycles);
  v.key({"load_words_per_core_clk", kRateLow, kRateHigh, kFaster,
         "32-bit loads and stores a core clock and core"},
        c.load_words_per_core_clk);
  v.key({"group_memory_words_per_core_clk", kRateLow, kRateHigh, kFaster,
         "32-bit group-memory accesses a core clock and core"},
        c.group_memory_words_per_core_clk);
  v.key({"atomic_lane_ops_per_clk", kRateLow, kRateHigh, kFit | kFaster,
         "atomics of the chip, mixed addresses"},
        c.atomic_lane_ops_per_clk);
  v.key({"atomic_same_address_ops_per_clk", kRateLow, kRateHigh, kFit | kFaster, "atomics on one address"},
        c.atomic_same_address_ops_per_clk);
}

template <class V, class T>
void describe_texture(V& v, GpuValues<T>& c) {
  v.key({"tex_bilinear_per_clk", kRateLow, kRateHigh, kRequired | kFaster,
         "bilinear probes, or unfiltered texels, of 32 bits"},
        c.tex_bilinear_per_clk);
  v.key({"tex_64bit_ratio", kRatioLow, 1, kFaster, "speed of unfiltered 64-bit texels, relative"},
        c.tex_64bit_ratio);
  v.key({"tex_128bit_ratio", kRatioLow, 1, kFaster, "speed of unfiltered 128-bit texels, relative"},
        c.tex_128bit_ratio);
  v.key({"tex_efficiency_ratio", kRatioLow, 1, kFit | kFaster, "of the probe rate, reached"},
        c.tex_efficiency_ratio);
  v.key({"tex_latency_cycles", 0, 1e5, kSlower,
         "core clocks of a texture request that hits in L1; part of the latencies below"},
        c.tex_latency_cycles);
  v.key({"l1_size_kib", 0.25, kKibHigh, kFaster, "texture cache of a core"}, c.l1_size_kib);
  v.key({"l1_ways", 1, 128, kNeither, "engine detailed: lines of a set of L1"}, c.l1_ways);
  v.key({"core_lines_max", 16, 65536, kFaster, "engine detailed: lines on their way to a core"},
        c.core_lines_max);
  v.key({"l1_fill_bytes_per_core_clk", kRateLow, kRateHigh, kFaster, "L2 to L1, a core clock and core"},
        c.l1_fill_bytes_per_core_clk);
}

template <class V, class T>
void describe_geometry(V& v, GpuValues<T>& c) {
  v.key({"draw_cycles", 0, 1e6, kFit | kSlower, "front end, a draw"}, c.draw_cycles);
  v.key({"state_change_cycles", 0, 1e6, kFit | kSlower, "front end, a pipeline or binding change"},
        c.state_change_cycles);
  v.key({"ia_indices_per_clk", 0, kRateHigh, kFaster,
         "indices fetched; 0: three for each triangle that setup can cull"},
        c.ia_indices_per_clk);
  v.key({"gs_output_words_per_core_clk", kRateLow, kRateHigh, kFit | kFaster,
         "32-bit values that geometry shaders emit, a core clock and core"},
        c.gs_output_words_per_core_clk);
  v.key({"gs_on_chip", 0, 0, kFaster,
         "geometry shaders' input and output stay on chip; else memory holds them between the stages"},
        c.gs_on_chip);
  v.key({"setup_drawn_triangles_per_clk", kRateLow, kRateHigh, kRequired | kFit | kFaster,
         "triangles sent to raster"},
        c.setup_drawn_triangles_per_clk);
  v.key({"setup_culled_triangles_per_clk", kRateLow, kRateHigh, kRequired | kFit | kFaster,
         "triangles that pass the culling stage, drawn ones too"},
        c.setup_culled_triangles_per_clk);
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
  v.key({"hiz_px_per_clk", kRateLow, kRateHigh, kRequired | kFit | kFaster,
         "pixels rejected by the coarse depth test"},
        c.hiz_px_per_clk);
}

template <class V, class T>
void describe_crop(V& v, GpuValues<T>& c) {
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
  v.key({"blend_rgba8_ratio", kRatioLow, 1, kFaster, "speed of blending 4 x 8 bit, relative to plain writes"},
        c.blend_rgba8_ratio);
  v.key(
      {"blend_other_ratio", kRatioLow, 1, kFaster, "speed of blending other formats up to 64 bit, relative"},
      c.blend_other_ratio);
  v.key({"blend_128bit_ratio", kRatioLow, 1, kFaster, "speed of blending 128 bit, relative"},
        c.blend_128bit_ratio);
  v.key(
      {"crop_msaa_samples_per_unit_clk", kRateLow, kRateHigh, kFaster, "multisample color, a clock and ROP"},
      c.crop_msaa_samples_per_unit_clk);
  v.key({"crop_compressible_at_pixel_rate", 0, 0, kFaster,
         "a pixel whose samples share one color costs the ROP one pixel, not its samples"},
        c.crop_compressible_at_pixel_rate);
  v.key({"resolve_samples_per_clk", 0, kRateHigh, kFaster, "samples averaged; 0: at the texture units' rate"},
        c.resolve_samples_per_clk);
}

template <class V, class T>
void describe_depth(V& v, GpuValues<T>& c) {
  v.key({"zrop_samples_per_unit_clk", kRateLow, kRateHigh, kRequired | kFaster,
         "depth samples tested and written, a clock and ROP"},
        c.zrop_samples_per_unit_clk);
  v.key({"zrop_efficiency_ratio", kRatioLow, 1, kFit | kFaster, "of that, reached"}, c.zrop_efficiency_ratio);
  v.key({"fast_clear_color", 0, 0, kFaster, "clears of color write a tile table only"}, c.fast_clear_color);
  v.key({"fast_clear_depth", 0, 0, kFaster, "clears of depth write a tile table only"}, c.fast_clear_depth);
  v.key({"fast_clear_color_bytes_per_tile", 0, 1e4, kSlower, "table bytes of an 8x8 color tile"},
        c.fast_clear_color_bytes_per_tile);
  v.key({"fast_clear_depth_bytes_per_tile", 0, 1e4, kSlower, "table bytes of an 8x8 depth tile"},
        c.fast_clear_depth_bytes_per_tile);
  v.key({"compression_granule_bytes", 1, 4096, kSlower, "compressed tiles and blocks move in whole granules"},
        c.compression_granule_bytes);
  v.key({"msaa_color_compression", 0, 0, kFaster, "samples of a pixel that share a color move once"},
        c.msaa_color_compression);
  v.key({"msaa_color_block_bytes", 0, 65536, kNeither,
         "samples compressed together, all pixels of one color or none; 0: each pixel by itself, with a mask "
         "that says which color a sample has"},
        c.msaa_color_block_bytes);
  v.key({"color_delta_ratio", kRatioLow, 1, kFit | kSlower,
         "bytes of single-sample color moved / uncompressed bytes"},
        c.color_delta_ratio);
  v.key({"depth_plane_slots", 0, 4, kFaster,
         "planes that a compressed 8x8 depth tile can hold: 4, 2 (as is 3), 1 or none"},
        c.depth_plane_slots);
  v.key({"depth_offset_forms", 0, 0, kFaster,
         "depth tiles as 6- or 14-bit distances from their nearest or farthest value"},
        c.depth_offset_forms);
}

template <class V, class T>
void describe_memory(V& v, GpuValues<T>& c) {
  v.key({"rop_through_l2", 0, 0, kNeither,
         "depth and color go through L2; otherwise through the ROPs' own caches"},
        c.rop_through_l2);
  v.key({"crop_cache_kib", 0, kKibHigh, kFaster, "color caches of the chip, before L2 or instead of it"},
        c.crop_cache_kib);
  v.key({"zrop_cache_kib", 0, kKibHigh, kFaster, "depth caches of the chip, before L2 or instead of it"},
        c.zrop_cache_kib);
  v.key({"l2_size_kib", 1, kKibHigh, kRequired | kFaster, "L2 of the chip (Intel: L3)"}, c.l2_size_kib);
  v.key({"l2_bytes_per_clk", kRateLow, kRateHigh, kRequired | kFit | kFaster, "L2 bandwidth"},
        c.l2_bytes_per_clk);
  v.key({"l2_latency_cycles", 0, 1e5, kSlower, "core clocks of a read that hits in L2"}, c.l2_latency_cycles);
  v.key({"l2_ways", 1, 128, kNeither, "engine detailed: lines of a set of L2"}, c.l2_ways);
  v.key({"unit_lines_max", 1, 1e6, kFaster,
         "64-byte lines that a fixed-function unit can have on their way from and to L2 and DRAM"},
        c.unit_lines_max);
  v.key({"dram_latency_cycles", 0, 1e5, kSlower, "core clocks of a read from DRAM, unloaded"},
        c.dram_latency_cycles);
  v.key({"llc_size_kib", 0, kKibHigh, kFaster, "cache between L2 and DRAM (Intel LLC, Infinity Cache, SLC)"},
        c.llc_size_kib);
  v.key({"dram_bandwidth_gb_s", kRateLow, 1e5, kRequired | kFit | kFaster, "peak, 1e9 bytes a second"},
        c.dram_bandwidth_gb_s);
  v.key({"dram_efficiency_ratio", kRatioLow, 1, kFit | kFaster, "of the peak, reached"},
        c.dram_efficiency_ratio);
  v.key({"dram_cpu_share_ratio", 0, 0.95, kFit | kSlower, "of what is reached, taken by the CPU"},
        c.dram_cpu_share_ratio);
  v.key({"dram_channels", 1, 256, kNeither, "engine detailed: independent channels"}, c.dram_channels);
  v.key({"dram_banks", 1, 256, kFaster, "engine detailed: banks of a channel"}, c.dram_banks);
  v.key({"dram_interleave_bytes", 64, 65536, kNeither,
         "engine detailed: neighboring bytes that go to one channel, in whole lines"},
        c.dram_interleave_bytes);
  v.key({"dram_queue_rows", 1, 64, kFaster,
         "engine detailed: rows of a bank whose requests the controller serves together"},
        c.dram_queue_rows);
  v.key({"dram_write_lines", 1, 4096, kFaster, "lines that a channel writes together, between two turns"},
        c.dram_write_lines);
  v.key({"dram_write_groups", 1, 64, kFaster, "engine detailed: such groups that a channel has room for"},
        c.dram_write_groups);
  v.key({"dram_row_bytes", 64, 1e6, kNeither, "engine detailed: an open row of a bank"}, c.dram_row_bytes);
  v.key({"dram_row_miss_ns", 0, 1e4, kNeither, "engine detailed: closing a row and opening another"},
        c.dram_row_miss_ns);
  v.key({"dram_row_cycle_ns", 0, 1e4, kSlower, "engine detailed: from one opening to the next, a bank"},
        c.dram_row_cycle_ns);
  v.key({"dram_turn_ns", 0, 1e4, kSlower, "a channel changes between reads and writes"}, c.dram_turn_ns);
  v.key({"tile_based", 0, 0, kNeither,
         "depth and color of a pass live in tile memory; geometry is binned through DRAM"},
        c.tile_based);
  v.key({"tile_px", 16, 65536, kNeither, "pixels of a screen tile, where the color of one fits tile memory"},
        c.tile_px);
  v.key({"tile_list_entry_bytes", 1, 1024, kSlower,
         "bytes that binning writes for a triangle in the list of a tile, and that the tile reads back"},
        c.tile_list_entry_bytes);
  v.key({"tile_memory_kib", kRatioLow, kKibHigh, kFaster,
         "color of a tile, all samples and targets: what needs more halves the tile"},
        c.tile_memory_kib);
}

template <class V, class T>
void describe_model(V& v, GpuValues<T>& c) {
  v.key({"pass_overhead_us", 0, 1e6, kFit | kSlower,
         "fixed cost of a pass that waits for an earlier one: drain, launch"},
        c.pass_overhead_us);
  v.key({"queue_packets", 2, 4096, kFaster,
         "subgroups' worth of work that wait between two units; engines queue and detailed"},
        c.queue_packets);
  v.key({"roofline_exponent", 1, 64, kFaster,
         "engine roofline: p of the norm over units; large: only the limiter counts"},
        c.roofline_exponent);
}

/// The numbers of the timing model, for any scalar type.
template <class V, class T>
void describe(V& v, GpuValues<T>& c) {
  describe_clocks(v, c);
  describe_shader(v, c);
  describe_texture(v, c);
  describe_geometry(v, c);
  describe_crop(v, c);
  describe_depth(v, c);
  describe_memory(v, c);
  describe_model(v, c);
}

template <class V>
void describe(V& v, GpuFeatures& f) {
  v.key({"features.native_msaa_max", 1, 64, kNoFlags, "largest sample count; a power of two"},
        f.native_msaa_max);
  v.key({"features.coverage_samples_max", 0, 32, kNoFlags,
         "coverage samples of a pixel beyond its color samples (CSAA, EQAA), both together; 0: none"},
        f.coverage_samples_max);
  v.key({"features.target_independent_raster", 0, 0, kNoFlags, "more raster samples than color samples"},
        f.target_independent_raster);
  v.key({"features.post_depth_coverage", 0, 0, kNoFlags, "shaders read the coverage after the depth test"},
        f.post_depth_coverage);
  v.key({"features.coverage_override", 0, 0, kNoFlags, "shaders widen the coverage"}, f.coverage_override);
  v.key({"features.viewport_multicast", 0, 0, kNoFlags,
         "one triangle to several viewports without a geometry shader"},
        f.viewport_multicast);
  v.key({"features.programmable_sample_positions", 0, 0, kNoFlags, "positions set by the application"},
        f.programmable_sample_positions);
  v.key({"features.conservative_raster", 0, 0, kNoFlags, "every pixel that a triangle touches"},
        f.conservative_raster);
  v.key({"features.compressed_depth_read", 0, 0, kNoFlags, "shaders read depth planes without decompression"},
        f.compressed_depth_read);
  v.key({"features.float_atomics", 0, 0, kNoFlags, "atomic addition of floats in buffers"}, f.float_atomics);
  v.key({"features.append_consume", 0, 0, kNoFlags, "counters of append and consume buffers"},
        f.append_consume);
  v.key({"features.tessellator_points", 0, 0, kNoFlags, "the tessellator emits points"},
        f.tessellator_points);
  v.key({"features.fragment_interlock", 0, 0, kNoFlags, "ordered read-modify-write of a pixel by shaders"},
        f.fragment_interlock);
}

template <class V>
void describe(V& v, FunctionalConfig& f) {
  v.key(
      {"functional.post_transform_cache_entries", 0, 4096, kNoFlags, "shaded vertices kept for reuse, FIFO"},
      f.post_transform_cache_entries);
  v.key({"functional.gs_max_scalars", 16, 65536, kNoFlags,
         "32-bit values of all vertices that one geometry shader invocation emits"},
        f.gs_max_scalars);
  v.key({"functional.late_z_on_discard", 0, 0, kNoFlags, "depth is written after a shader that can discard"},
        f.late_z_on_discard);
  v.key({"functional.hierarchical_z", 0, 0, kNoFlags,
         "a coarse depth test rejects and accepts 8x8 tiles whole"},
        f.hierarchical_z);
  v.key({"functional.max_image_px", 1, 65536, kNoFlags, "largest width or height of an image"},
        f.max_image_px);
}

template <class V>
void describe(V& v, GpuConfig& c) {
  v.key({"title", 0, 0, kRequired, "name for people"}, c.title);
  v.key({"vendor", 0, 0, kNoFlags, "maker"}, c.vendor);
  v.key({"architecture", 0, 0, kNoFlags, "chip and generation"}, c.architecture);
  describe(v, static_cast<GpuValues<double>&>(c));
  describe(v, c.features);
  describe(v, c.functional);
}

}  // namespace hwsim
