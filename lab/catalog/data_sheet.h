#pragma once
// A GPU of a data sheet: what the sheet prints, and what follows from it on a GPU of the same kind.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "hwsim/gpu/gpu_config.h"
#include "lab/base/table.h"

namespace hwsim::lab {

/// What data sheets print. What is not given stays as it is in the GPU of the same kind, or follows what was
/// given.
struct DataSheet {
  std::string id{}, title{};
  std::optional<double> cores{};           ///< SMs, compute units, SIMD engines
  std::optional<double> rops{};            ///< pixels a clock
  std::optional<double> tmus{};            ///< bilinear probes a clock
  std::optional<double> rasterizers{};     ///< GPCs, shader engines
  std::optional<double> clock_mhz{};       ///< clock of the core
  std::optional<double> bandwidth_gb_s{};  ///< 1e9 bytes a second
  std::optional<double> l2_kib{};
  std::optional<double> llc_kib{};  ///< Infinity Cache and the like
};

/// A key of the new GPU that differs from the other's, or that the sheet gives.
struct SheetValue {
  std::string key{};
  double before = 0.0, after = 0.0;
  std::optional<std::array<double, 2>> interval{};  ///< from unchanged to fully scaled, where it was guessed
  std::string how{};                                ///< "data sheet", "scales with crop_units: ..."
};

struct SheetGpu {
  GpuConfig gpu;
  std::string like;  ///< the GPU that its file extends
  std::vector<SheetValue> values;
};

/// Throws InputError C014 with every number outside of its key's range.
SheetGpu gpu_of_sheet(const GpuConfig& like, const DataSheet& sheet);

/// The file of the GPU: it extends the other one.
std::string to_toml(const SheetGpu& gpu);

/// What was given and what was guessed.
Table sheet_table(const SheetGpu& gpu);

/// Warnings C024: rates of the GPU that its file takes over from the GPU that it extends, while it changes
/// the size that they depend on.
std::vector<Diagnostic> kept_rates(const GpuConfig& gpu);

/// "4", "512K", "36M" or "1G" as KiB; a bare number is KiB. None for anything else.
std::optional<double> size_in_kib(std::string_view text);

}  // namespace hwsim::lab
