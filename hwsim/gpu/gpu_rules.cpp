// Rules over several keys of a GPU. Each names every key involved and the values found.
#include <algorithm>
#include <cctype>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "hwsim/config/assign.h"
#include "hwsim/gpu/gpu_keys.h"
#include "hwsim/gpu/gpu_rules.h"
#include "hwsim/trace/counters.h"

namespace hwsim {
namespace {

class RuleCheck {
 public:
  RuleCheck(const GpuConfig& config, std::vector<Diagnostic>& problems)
      : config_(config), problems_(problems) {}

  void require(bool holds, std::string message, std::vector<std::string> keys) {
    if (holds) return;
    Diagnostic d;
    d.code = "C018";
    d.message = std::move(message);
    d.place = place_of(keys.front());
    d.help = "change one of them";
    for (const std::string& key : keys) {
      const auto origin = config_.origins.find(key);
      const std::string from = origin == config_.origins.end() ? "" : " (" + origin->second.to_string() + ")";
      d.notes.push_back(key + " = " + value_of(config_, key) + from);
    }
    problems_.push_back(std::move(d));
  }

 private:
  /// The file and line that gave the first key, where one did.
  SourcePlace place_of(const std::string& key) const {
    SourcePlace place;
    const auto origin = config_.origins.find(key);
    if (origin == config_.origins.end()) return place;
    place.file = origin->second.layer == Origin::Layer::command_line ? "(command line)" : origin->second.file;
    place.line = origin->second.line;
    return place;
  }

  const GpuConfig& config_;
  std::vector<Diagnostic>& problems_;
};

constexpr bool is_power_of_two(int n) { return n > 0 && (n & (n - 1)) == 0; }

}  // namespace

void check_rules(const GpuConfig& c, std::vector<Diagnostic>& problems) {
  RuleCheck check(c, problems);
  check.require(
      std::find(kSubgroupWidths.begin(), kSubgroupWidths.end(), c.subgroup_size) != kSubgroupWidths.end(),
      "`subgroup_size` must be 8, 16, 32 or 64: divergence is counted for these", {"subgroup_size"});
  check.require(c.vliw_fill_slots <= c.vliw_slots, "`vliw_fill_slots` must not exceed `vliw_slots`",
                {"vliw_fill_slots", "vliw_slots"});
  check.require(c.vliw_slots <= c.fp32_lanes_per_core,
                "`vliw_slots` must not exceed `fp32_lanes_per_core`: lanes count every slot",
                {"vliw_slots", "fp32_lanes_per_core"});
  check.require(is_power_of_two(c.features.native_msaa_max),
                "`features.native_msaa_max` must be a power of two", {"features.native_msaa_max"});
  check.require(c.tex_128bit_ratio <= c.tex_64bit_ratio,
                "`tex_128bit_ratio` must not exceed `tex_64bit_ratio`",
                {"tex_128bit_ratio", "tex_64bit_ratio"});
  check.require(c.export_128bit_ratio <= c.export_64bit_ratio,
                "`export_128bit_ratio` must not exceed `export_64bit_ratio`",
                {"export_128bit_ratio", "export_64bit_ratio"});
}

bool applies(std::string_view key, const GpuValues<double>& gpu) {
  if (key.starts_with("vliw_")) return gpu.vliw_slots > 1.0;
  return gpu.tile_based || key == "tile_based" || !key.starts_with("tile_");
}

void check_ids(std::span<const GpuConfig> gpus, std::vector<Diagnostic>& problems) {
  const auto folder = [](std::string id) {
    for (char& c : id)
      if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '.') c = '_';
    return id;
  };
  for (std::size_t i = 0; i < gpus.size(); ++i)
    for (std::size_t before = 0; before < i; ++before) {
      if (folder(gpus[i].id) != folder(gpus[before].id)) continue;
      if (gpus[i].id == gpus[before].id && content_hash(gpus[i]) == content_hash(gpus[before])) continue;
      Diagnostic d;
      d.code = "C023";
      d.message =
          "two GPUs name one folder of results: \"" + gpus[before].id + "\" and \"" + gpus[i].id + "\"";
      d.help = "give one of their files another `id`, or run them apart";
      problems.push_back(std::move(d));
      break;
    }
}

void validate(const GpuConfig& config) {
  GpuConfig copy = config;
  std::vector<Diagnostic> problems;
  for (const Key& key : keys_of(copy))
    if (auto problem = check_range(key)) problems.push_back(std::move(*problem));
  if (problems.empty()) check_rules(config, problems);
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace hwsim
