#include "lab/catalog/data_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "hwsim/config/assign.h"
#include "hwsim/gpu/gpu_keys.h"
#include "hwsim/gpu/gpu_show.h"

namespace hwsim::lab {
namespace {

/// A rate that belongs to a size: whoever changes the size changes the rate, too.
struct Dependency {
  std::string_view rate, size, why;
  bool is_part = false;  ///< the rate is made of the size's parts: it never stays when the size changes
};

/// In the order in which guesses follow from each other.
constexpr Dependency kDependencies[] = {
    {"raster_engines", "shader_cores", "a rasterizer serves a group of cores"},
    {"tex_bilinear_per_clk", "shader_cores", "texture units are part of the cores", true},
    {"export_px_per_clk", "crop_units", "the path to the ROPs is as wide as they are", true},
    {"atomic_lane_ops_per_clk", "crop_units", "atomics run beside the ROPs"},
    {"raster_samples_per_clk", "raster_engines", "of all rasterizers", true},
    {"hiz_px_per_clk", "raster_engines", "of all rasterizers", true},
    {"setup_drawn_triangles_per_clk", "raster_engines", "of all rasterizers", true},
    {"setup_culled_triangles_per_clk", "raster_engines", "of all rasterizers", true},
    {"l2_bytes_per_clk", "dram_bandwidth_gb_s", "a slice of L2 for each memory channel"},
    {"dram_channels", "dram_bandwidth_gb_s", "more bandwidth by more channels"},
    {"unit_lines_max", "dram_bandwidth_gb_s", "enough lines on their way to keep DRAM busy"},
};

double number_in(const KeySlot& slot) {
  if (const auto* whole = std::get_if<int*>(&slot)) return **whole;
  return *std::get<double*>(slot);
}

class Sheet {
 public:
  explicit Sheet(const GpuConfig& like) : result_{like, like.id, {}} {
    keys_ = keys_of(result_.gpu);
    for (const Key& key : keys_)
      if (std::holds_alternative<double*>(key.slot) || std::holds_alternative<int*>(key.slot))
        before_[std::string(key.info.name)] = number_in(key.slot);
  }

  void give(const std::string& key, const std::optional<double>& value) {
    if (value) set(key, *value, Provenance::published, "data sheet");
  }

  void guess(const Dependency& d) {
    const std::string rate(d.rate), size(d.size);
    const double ratio = now(size) / before_.at(size);
    if (given_.contains(rate) || ratio == 1.0) return;
    const double before = before_.at(rate);
    if (before == 0.0) return;  // 0 says: as another key decides
    set(rate, before * ratio, Provenance::assumed, fmt::format("scales with {}: {}", size, d.why));
  }

  SheetGpu take(const DataSheet& sheet) {
    if (!problems_.empty()) throw InputError(problems_);
    result_.gpu.id = sheet.id;
    result_.gpu.title = sheet.title.empty() ? sheet.id : sheet.title;
    result_.gpu.origins["title"].layer = Origin::Layer::file;
    return std::move(result_);
  }

 private:
  double now(const std::string& key) const { return number_in(find_key(keys_, key)->slot); }

  void set(const std::string& name, double value, Provenance provenance, const std::string& how) {
    const Key& key = *find_key(keys_, name);
    const bool whole = std::holds_alternative<int*>(key.slot) || key.info.has(kWhole);
    if (whole) value = std::round(value);
    if (provenance == Provenance::assumed) value = std::clamp(value, key.info.low, key.info.high);
    if (value < key.info.low || value > key.info.high || !std::isfinite(value)) {
      problems_.push_back({.code = "C014",
                           .message = fmt::format("{} would be {:g}, must be from {:g} to {:g}", name, value,
                                                  key.info.low, key.info.high),
                           .help = "give the numbers of one data sheet, in the units that --help names"});
      return;
    }
    if (auto* slot = std::get_if<int*>(&key.slot))
      **slot = static_cast<int>(value);
    else
      *std::get<double*>(key.slot) = value;
    given_.insert(name);
    const double before = before_.at(name);
    std::optional<std::array<double, 2>> interval;
    if (provenance == Provenance::assumed) interval = {std::min(before, value), std::max(before, value)};
    result_.values.push_back({name, before, value, interval, how});
    Origin& origin = result_.gpu.origins[name];
    origin = {};
    origin.layer = Origin::Layer::file;
    origin.provenance = provenance;
    origin.source = how;
    origin.interval = interval;
  }

  SheetGpu result_;
  std::vector<Key> keys_;
  std::map<std::string, double> before_;
  std::set<std::string> given_;
  std::vector<Diagnostic> problems_;
};

bool in_own_file(const GpuConfig& gpu, std::string_view key) {
  const auto origin = gpu.origins.find(key);
  return origin != gpu.origins.end() && origin->second.layer == Origin::Layer::file;
}

}  // namespace

SheetGpu gpu_of_sheet(const GpuConfig& like, const DataSheet& sheet) {
  Sheet made(like);
  made.give("core_clock_mhz", sheet.clock_mhz);
  made.give("shader_cores", sheet.cores);
  made.give("tex_bilinear_per_clk", sheet.tmus);
  made.give("crop_units", sheet.rops);
  made.give("raster_engines", sheet.rasterizers);
  made.give("l2_size_kib", sheet.l2_kib);
  made.give("llc_size_kib", sheet.llc_kib);
  made.give("dram_bandwidth_gb_s", sheet.bandwidth_gb_s);
  for (const Dependency& dependency : kDependencies) made.guess(dependency);
  return made.take(sheet);
}

std::string to_toml(const SheetGpu& made) {
  std::set<std::string> keys = {"title"};
  for (const SheetValue& value : made.values) keys.insert(value.key);
  return "# Written by `hwsim gpu new`: numbers of a data sheet over a GPU of the same kind. What is "
         "`assumed` was "
         "scaled.\n" +
         show_extension(made.gpu, made.like, keys);
}

Table sheet_table(const SheetGpu& made) {
  Table table{{{"key", "key"},
               {"before", made.like, true},
               {"value", made.gpu.id, true},
               {"low", "from", true},
               {"high", "to", true},
               {"how", "how"}},
              {}};
  for (const SheetValue& v : made.values) {
    const auto bound = [&](std::size_t i) -> TableCell {
      return v.interval ? TableCell{fmt::format("{:g}", (*v.interval)[i])} : TableCell{NotApplicable{}};
    };
    table.rows.push_back(
        {v.key, fmt::format("{:g}", v.before), fmt::format("{:g}", v.after), bound(0), bound(1), v.how});
  }
  return table;
}

std::vector<Diagnostic> kept_rates(const GpuConfig& gpu) {
  std::vector<Diagnostic> warnings;
  for (const Dependency& d : kDependencies) {
    const auto rate = gpu.origins.find(d.rate);
    const bool kept = d.is_part && rate != gpu.origins.end() && rate->second.layer == Origin::Layer::parent;
    if (!kept || !in_own_file(gpu, d.size)) continue;
    Diagnostic warning{
        .severity = Severity::warning,
        .code = "C024",
        .message = fmt::format("`{}` changes `{}` and keeps `{}` of the GPU that it extends: {}", gpu.id,
                               d.size, d.rate, d.why),
        .help = fmt::format("write `{}` too, or begin with `hwsim gpu new`", d.rate)};
    warning.place.file = gpu.origins.find(d.size)->second.file;
    warning.place.line = gpu.origins.find(d.size)->second.line;
    warnings.push_back(std::move(warning));
  }
  return warnings;
}

std::optional<double> size_in_kib(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !(value >= 0.0) || !std::isfinite(value)) return std::nullopt;
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  for (const auto& [name, kib] :
       {std::pair{"", 1.0}, std::pair{"K", 1.0}, std::pair{"M", 1024.0}, std::pair{"G", 1024.0 * 1024.0}})
    if (unit == name) return value * kib;
  return std::nullopt;
}

}  // namespace hwsim::lab
