#include "lab/catalog/catalog.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "algos/techniques.h"
#include "hwsim/base/csv.h"
#include "hwsim/gpu/gpu_config.h"
#include "hwsim/trace/counters.h"
#include "lab/base/files.h"
#include "pipeline/open/scene_source.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

constexpr size_t kTextColumns = 72;

fs::path published_directory() { return fs::path(config_directory()) / "published"; }

}  // namespace

Table gpu_catalog() {
  Table table{{{"id", "id"},
               {"title", "title"},
               {"architecture", "architecture"},
               {"core_clock_mhz", "core MHz", true},
               {"dram_bandwidth_gb_s", "DRAM GB/s", true}},
              {}};
  const std::string directory = gpu_directory();
  for (const std::string& id : list_gpus(directory)) {
    const GpuConfig gpu = load_gpu(id, {}, {}, directory);
    table.rows.push_back(
        {gpu.id, gpu.title, gpu.architecture, Real{gpu.core_clock_mhz, 0}, Real{gpu.dram_bandwidth_gb_s, 1}});
  }
  return table;
}

Table scene_catalog() {
  Table table{
      {{"name", "name"}, {"parameters", "parameters", false, 40}, {"description", "description", false, 60}},
      {}};
  for (const pipeline::GeneratorInfo& info : pipeline::generators()) {
    std::string parameters;
    for (const pipeline::GeneratorParameter& parameter : info.parameters)
      parameters +=
          fmt::format("{}{}={}", parameters.empty() ? "" : ", ", parameter.name, parameter.default_value);
    table.rows.push_back({info.name, parameters, info.description});
  }
  return table;
}

Table technique_catalog() {
  Table table{{{"name", "name"},
               {"kind", "kind"},
               {"parameters", "parameters", false, 40},
               {"description", "description", false, 60}},
              {}};
  for (const algos::TechniqueInfo& info : algos::techniques()) {
    std::string parameters;
    for (const algos::OptionInfo& option : info.options)
      parameters += (parameters.empty() ? "" : ", ") + std::string(option.name);
    table.rows.push_back({std::string(info.id), std::string(algos::kind_name(info.kind())), parameters,
                          std::string(info.description)});
  }
  return table;
}

Table counter_catalog_table() {
  Table table{{{"id", "id"},
               {"unit", "unit"},
               {"unit_kind", "kind"},
               {"description", "one count is", false, kTextColumns}},
              {}};
  for (const auto& [info, place] : algos::counters())
    table.rows.push_back({std::string(info.id), std::string(info.unit), std::string(info.unit_kind),
                          std::string(info.description)});
  return table;
}

Table table_catalog() {
  Table table{{{"name", "name"}, {"rows", "rows", true}, {"columns", "columns", false, kTextColumns}}, {}};
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(published_directory(), error)) {
    if (entry.path().extension() != ".csv") continue;
    const Table content = read_table(entry.path().string());
    std::string columns;
    for (const Column& column : content.columns) columns += (columns.empty() ? "" : " ") + column.id;
    table.rows.push_back({entry.path().stem().string(), std::uint64_t{content.rows.size()}, columns});
  }
  std::sort(table.rows.begin(), table.rows.end(), [](const auto& a, const auto& b) {
    return std::get<std::string>(a[0]) < std::get<std::string>(b[0]);
  });
  return table;
}

std::vector<std::string> names_of(const Table& catalog) {
  std::vector<std::string> names;
  for (const auto& row : catalog.rows) names.push_back(std::get<std::string>(row.front()));
  return names;
}

Table read_table(const std::string& path) {
  const CsvFile file = read_csv(path);
  Table table;
  for (const std::string& id : file.header) table.columns.push_back({id, id});
  for (const std::vector<std::string>& row : file.rows) table.rows.emplace_back(row.begin(), row.end());
  return table;
}

std::string published_table_path(const std::string& name) {
  return (published_directory() / (name + ".csv")).string();
}

}  // namespace hwsim::lab
