#pragma once
// A GPU as files describe it. Rates are documented in docs/hardware_model.md; every key is declared in
// the header of its unit.
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
#include "hwsim/units/units.h"

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

/// Ends the list of bases.
struct NoValues {};

/// The numbers that enter the timing model, over the scalar type: double to predict, Jets to fit. Each unit
/// has its own (hwsim/units). "clk" is the core clock of the whole chip unless the key says per core, per
/// engine or per unit.
#define HWSIM_PART_VALUES(id, Name) units::Name::Values<T>,
template <class T>
struct GpuValues : HWSIM_GPU_PARTS(HWSIM_PART_VALUES) NoValues {
  using Scalar = T;
};
#undef HWSIM_PART_VALUES

struct GpuConfig : GpuValues<double> {
  std::string id;
  std::vector<std::string> parents;  ///< ids of the GPUs that its file extends, the nearest first
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
