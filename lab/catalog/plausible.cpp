#include "lab/catalog/plausible.h"

#include <fmt/format.h>

#include "hwsim/config/assign.h"
#include "hwsim/gpu/gpu_keys.h"

namespace hwsim::lab {
namespace {

/// What was built, with room for what may come.
struct Plausible {
  std::string_view key;
  double low, high;
  std::string_view unit;              ///< "MHz", or what is counted
  std::string_view larger_unit = "";  ///< in which data sheets may print it
  double larger_is = 1.0;             ///< so many of the unit
};

constexpr Plausible kPlausible[] = {
    {"core_clock_mhz", 100.0, 5000.0, "MHz", "GHz", 1000.0},
    {"dram_bandwidth_gb_s", 4.0, 20'000.0, "GB/s", "TB/s", 1000.0},
    {"l2_size_kib", 64.0, 1'048'576.0, "KiB", "MiB", 1024.0},
    {"llc_size_kib", 512.0, 4'194'304.0, "KiB", "MiB", 1024.0},
    {"shader_cores", 1.0, 512.0, "SMs or compute units, not lanes"},
    {"tex_bilinear_per_clk", 1.0, 2048.0, "bilinear probes in a clock of the whole chip"},
    {"crop_units", 1.0, 512.0, "pixels that the ROPs write in a clock"},
    {"raster_engines", 1.0, 64.0, "GPCs or shader engines"},
};

double number_in(const KeySlot& slot) {
  if (const auto* const* whole = std::get_if<int*>(&slot)) return **whole;
  return *std::get<double*>(slot);
}

std::string remedy(const Plausible& range, double value) {
  const double larger = value * range.larger_is;
  const std::string_view verb = range.larger_unit.empty() ? "counts" : "is in";
  std::string text = fmt::format("`{}` {} {}", range.key, verb, range.unit);
  if (value < range.low && larger >= range.low && larger <= range.high)
    text += fmt::format(": {:.0f} if {:g} {} was meant", larger, value, range.larger_unit);
  return text;
}

SourcePlace place_of(const GpuConfig& gpu, std::string_view key) {
  const auto origin = gpu.origins.find(key);
  if (origin == gpu.origins.end()) return {};
  SourcePlace place;
  place.file = origin->second.layer == Origin::Layer::command_line ? "(command line)" : origin->second.file;
  place.line = origin->second.line;
  return place;
}

}  // namespace

std::vector<Diagnostic> implausible_numbers(const GpuConfig& gpu) {
  std::vector<Diagnostic> warnings;
  GpuConfig copy = gpu;
  const std::vector<Key> keys = keys_of(copy);
  for (const Plausible& range : kPlausible) {
    const double value = number_in(find_key(keys, range.key)->slot);
    const bool is_none = value == 0.0;  // a cache that is not there
    if (is_none || (value >= range.low && value <= range.high)) continue;
    warnings.push_back({.severity = Severity::warning,
                        .code = "C027",
                        .message = fmt::format("`{}` is {:g} in gpu \"{}\": GPUs have from {:g} to {:g}",
                                               range.key, value, gpu.id, range.low, range.high),
                        .place = place_of(gpu, range.key),
                        .help = remedy(range, value)});
  }
  return warnings;
}

}  // namespace hwsim::lab
