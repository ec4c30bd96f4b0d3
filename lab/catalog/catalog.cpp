#include "lab/catalog/catalog.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "algos/techniques.h"
#include "cost_models/intervals.h"
#include "hwsim/base/csv.h"
#include "hwsim/config/toml_file.h"
#include "hwsim/gpu/gpu_config.h"
#include "lab/catalog/config_files.h"
#include "pipeline/open/scene_source.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

constexpr size_t kTextColumns = 72;

/// What the best interval of a GPU's frames rests on.
std::string calibrated_text(const cost_models::Calibration* calibration, const GpuConfig& gpu) {
  const std::string fitted = calibration ? cost_models::calibrated_id(*calibration, gpu) : std::string();
  if (fitted.empty()) return "no";
  if (fitted != gpu.id) return "by " + fitted;
  return cost_models::credible(*calibration, fitted) ? "yes" : "in part";
}

}  // namespace

Table Catalog::gpus() const {
  Table table{{{"id", "id"},
               {"title", "title"},
               {"architecture", "architecture"},
               {"core_clock_mhz", "core MHz", true},
               {"dram_bandwidth_gb_s", "DRAM GB/s", true},
               {"calibrated", "calibrated"}},
              {}};
  const std::string directory = folder_.gpus();
  const auto calibration = ConfigFiles(folder_).calibration();
  for (const std::string& id : list_gpus(directory)) {
    const GpuConfig gpu = load_gpu(id, {}, {}, directory);
    table.rows.push_back({gpu.id, gpu.title, gpu.architecture, Real{gpu.core_clock_mhz, 0},
                          Real{gpu.dram_bandwidth_gb_s, 1}, calibrated_text(calibration.get(), gpu)});
  }
  return table;
}

Table Catalog::scenes() const {
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

Table Catalog::techniques() const {
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

Table Catalog::counters() const {
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

Table Catalog::overlays() const {
  Table table{{{"name", "name"}, {"about", "what if", false, 60}, {"changes", "changes", false, 50}}, {}};
  for (const std::string& name : folder_.overlay_names()) {
    std::vector<Diagnostic> problems;
    std::string about, changes;
    for (const TomlEntry& entry : read_toml_file(folder_.overlay_file(name), problems).entries) {
      if (!entry.value || entry.path == "schema" || entry.path == "kind") continue;
      const auto* text = std::get_if<std::string>(&*entry.value);
      if (entry.path == "about" && text)
        about = *text;
      else
        changes += (changes.empty() ? "" : ", ") + entry.path + " " + (text ? *text : to_toml(*entry.value));
    }
    table.rows.push_back({name, about, changes});
  }
  return table;
}

Table Catalog::published_tables() const {
  Table table{{{"name", "name"}, {"rows", "rows", true}, {"columns", "columns", false, kTextColumns}}, {}};
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_.published(), error)) {
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

Table Catalog::papers() const {
  std::map<std::string, std::pair<std::uint64_t, std::string>> papers;
  for (const std::string& name : names_of(published_tables())) {
    const Table content = read_table(folder_.published() + "/" + name + ".csv");
    if (content.rows.empty()) continue;
    auto& [rows, tables] = papers[std::get<std::string>(content.rows.front().front())];
    rows += content.rows.size();
    tables += (tables.empty() ? "" : ", ") + name;
  }
  Table table{{{"name", "name"}, {"rows", "rows", true}, {"tables", "tables", false, kTextColumns}}, {}};
  for (const auto& [name, held] : papers) table.rows.push_back({name, held.first, held.second});
  return table;
}

Table Catalog::sources() const {
  Table table{
      {{"key", "key"}, {"document", "document", false, kTextColumns}, {"taken", "what was taken", false, 40}},
      {}};
  const fs::path place = fs::path(folder_.path()) / "sources.csv";
  std::error_code error;
  if (!fs::exists(place, error)) return table;  // a folder of one's own need not have it
  const CsvFile file = read_csv(place.string());
  const std::size_t key = file.column("key"), document = file.column("document"),
                    taken = file.column("taken");
  for (const std::vector<std::string>& row : file.rows)
    table.rows.push_back({row[key], row[document], row[taken]});
  return table;
}

Table Catalog::sources_in(const std::vector<std::string>& texts) const {
  Table table = sources();
  std::erase_if(table.rows, [&](const std::vector<TableCell>& row) {
    const std::string key = std::get<std::string>(row.front());
    return std::ranges::none_of(texts, [&](const std::string& text) {
      return text.find("[" + key + "]") != std::string::npos ||
             text.find("[" + key + ",") != std::string::npos;
    });
  });
  return table;
}

Table Catalog::codes() const {
  Table table{{{"code", "code"}, {"title", "message"}}, {}};
  for (const ErrorCode& code : error_codes())
    table.rows.push_back({std::string(code.code), std::string(code.title)});
  return table;
}

Table read_table(const std::string& path) {
  const CsvFile file = read_csv(path);
  Table table;
  for (const std::string& id : file.header) table.columns.push_back({id, id});
  for (const std::vector<std::string>& row : file.rows) table.rows.emplace_back(row.begin(), row.end());
  return table;
}

std::vector<std::string> names_of(const Table& table) {
  std::vector<std::string> names;
  for (const auto& row : table.rows) names.push_back(std::get<std::string>(row.front()));
  return names;
}

std::vector<std::string> Catalog::entry_names() const {
  std::vector<std::string> names;
  for (const Table& table : {scenes(), techniques(), counters(), published_tables()})
    for (std::string& name : names_of(table)) names.push_back(std::move(name));
  return names;
}

}  // namespace hwsim::lab
