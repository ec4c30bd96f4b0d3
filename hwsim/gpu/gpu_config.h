#pragma once
// A GPU as files describe it. Rates are documented in docs/hardware_model.md; every key is declared in
// gpu_keys.h.
#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hwsim/config/key.h"
#include "hwsim/config/toml_value.h"
#include "hwsim/gpu/gpu_features.h"

namespace hwsim {

enum class Provenance : unsigned char { published, measured, fitted, derived, assumed };
std::string_view provenance_name(Provenance provenance);

/// Where the value of a key came from.
struct Origin {
  enum class Layer : unsigned char { built_in, file, parent, overlay, command_line };
  Layer layer = Layer::built_in;
  std::optional<Provenance> provenance;
  std::string source;                             ///< free text: "[B3D-F]"
  std::optional<std::array<double, 2>> interval;  ///< bounds for calibration, or of a fit
  std::string file;                               ///< empty when built in or set on the command line
  int line = 0;
  std::string to_string() const;  ///< "gtx470.toml:12, published [HEX]", "--set", "built-in default, assumed"
};

/// The numbers that enter the timing model, over the scalar type: double to predict, Jets to fit.
/// "clk" is the core clock of the whole chip unless the key says per core, per engine or per unit.
template <class T>
struct GpuValues {
  T core_clock_mhz{0.0};
  T shader_clock_ratio{1.0};

  T shader_cores{0.0};
  T fp32_lanes_per_core{0.0};
  T sfu_lanes_per_core{0.0};
  int subgroup_size = 32;
  T vliw_slots{1.0};
  T vliw_fill_slots{1.0};
  T alu_efficiency_ratio{1.0};
  T interp_scalars_per_core_clk{0.0};
  bool interp_on_alu = false;
  T registers_kib_per_core{256.0};
  T group_memory_kib_per_core{32.0};
  T subgroups_per_core_max{48.0};
  T alu_latency_cycles{8.0};
  T load_words_per_core_clk{16.0};
  T group_memory_words_per_core_clk{32.0};
  T atomic_lane_ops_per_clk{64.0};
  T atomic_same_address_ops_per_clk{1.0};

  T tex_bilinear_per_clk{0.0};
  T tex_64bit_ratio{1.0};
  T tex_128bit_ratio{0.25};
  T tex_efficiency_ratio{1.0};
  T tex_latency_cycles{150.0};
  T l1_size_kib{16.0};
  int l1_ways = 8;
  int core_lines_max = 256;
  T l1_fill_bytes_per_core_clk{64.0};

  T draw_cycles{8.0};
  T state_change_cycles{16.0};
  T ia_indices_per_clk{0.0};
  T gs_output_words_per_core_clk{4.0};
  bool gs_on_chip = true;
  T setup_drawn_triangles_per_clk{0.0};
  T setup_culled_triangles_per_clk{0.0};
  T raster_engines{1.0};
  T raster_px_per_engine_clk{0.0};
  T raster_samples_per_clk{0.0};
  T raster_tiles_per_engine_clk{1.0};
  T hiz_px_per_clk{0.0};

  T zrop_samples_per_unit_clk{0.0};
  T zrop_efficiency_ratio{1.0};
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
  T resolve_samples_per_clk{0.0};

  bool fast_clear_color = true;
  bool fast_clear_depth = true;
  T fast_clear_color_bytes_per_tile{0.5};
  T fast_clear_depth_bytes_per_tile{4.0};
  int compression_granule_bytes = 32;
  bool msaa_color_compression = true;
  int msaa_color_block_bytes = 0;
  T color_delta_ratio{1.0};
  int depth_plane_slots = 4;
  bool depth_offset_forms = false;

  bool rop_through_l2 = true;
  T crop_cache_kib{16.0};
  T zrop_cache_kib{16.0};
  T l2_size_kib{0.0};
  T l2_bytes_per_clk{0.0};
  T l2_latency_cycles{220.0};
  int l2_ways = 16;
  T unit_lines_max{512.0};
  T dram_latency_cycles{400.0};
  T llc_size_kib{0.0};
  T dram_bandwidth_gb_s{0.0};
  T dram_efficiency_ratio{0.8};
  T dram_cpu_share_ratio{0.0};
  int dram_channels = 4;
  int dram_banks = 16;
  int dram_interleave_bytes = 256;
  int dram_queue_rows = 4;
  int dram_write_lines = 32;
  int dram_write_groups = 2;
  T dram_row_bytes{2048.0};
  T dram_row_miss_ns{26.0};
  T dram_row_cycle_ns{43.0};
  T dram_turn_ns{8.0};
  bool tile_based = false;
  int tile_px = 256;
  T tile_list_entry_bytes{8.0};
  T tile_memory_kib{8.0};

  T pass_overhead_us{10.0};
  int queue_packets = 64;
  T roofline_exponent{8.0};
};

struct GpuConfig : GpuValues<double> {
  std::string id;
  std::string title;
  std::string vendor;
  std::string architecture;
  GpuFeatures features;
  FunctionalConfig functional;
  std::map<std::string, Origin, std::less<>> origins;  ///< by key, every key; not part of the hash
};

/// The GPU files of `config_dir`, without ".toml", sorted.
std::vector<std::string> list_gpus(const std::string& config_dir);

/// Base file, its `extends` chain, overlay files in order, then those of `sets` whose group is "gpu" (the
/// others belong to other groups); then ranges and cross-field rules. `id_or_path` is an id in `config_dir`
/// or a path ending in
/// ".toml". Throws InputError with every problem found.
GpuConfig load_gpu(const std::string& id_or_path, std::span<const std::string> overlays,
                   std::span<const Assignment> sets, const std::string& config_dir);

/// Ranges and cross-field rules of a config that was built in code. Throws InputError.
void validate(const GpuConfig& config);

/// JSON Schema (draft 2020-12) of a GPU file, overlays included.
std::string gpu_schema_json();

/// Every key with its range, default and meaning, in file order; names are those of files
/// ("features.float_atomics").
std::vector<KeyInfo> gpu_keys();

/// A complete TOML file that loads to the same numbers; with_origin adds a comment to each key.
std::string show(const GpuConfig& config, bool with_origin);

/// The value of a key as TOML; empty for an unknown key.
std::string value_of(const GpuConfig& config, std::string_view key);

/// 64-bit hash of everything that changes a prediction, as 16 hex digits; equal numbers give equal hashes.
std::string content_hash(const GpuConfig& config);

/// The same for what changes the functional emulator only (features and functional): part of a trace's cache
/// key.
std::string functional_hash(const GpuConfig& config);

/// Explanations for `hwsim help C012`.
struct ConfigCode {
  std::string_view code, title, explanation;
};
std::span<const ConfigCode> config_codes();

}  // namespace hwsim
