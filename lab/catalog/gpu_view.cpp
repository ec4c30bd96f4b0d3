#include "lab/catalog/gpu_view.h"

#include "hwsim/config/settings.h"

namespace hwsim::lab {

GpuConfig load_gpu_from_options(const ConfigFolder& folder, const std::string& name,
                                const std::vector<std::string>& overlays,
                                const std::vector<std::string>& sets) {
  std::vector<Assignment> assignments;
  for (const std::string& text : sets) assignments.push_back(parse_assignment(text));
  check_groups(assignments, std::vector<std::string>{"gpu"});
  std::vector<std::string> files;
  for (const std::string& overlay : overlays) files.push_back(folder.overlay_file(overlay));
  return load_gpu(name, files, assignments, folder.gpus());
}

Table key_table(const GpuConfig& gpu, bool with_origin) {
  Table table{{{"key", "key"}, {"value", "value", true}}, {}};
  if (with_origin) table.columns.push_back({"origin", "origin"});
  table.columns.push_back({"description", "meaning", false, 72});
  for (const KeyInfo& key : gpu_keys()) {
    std::vector<TableCell> row = {std::string(key.name), value_of(gpu, key.name)};
    if (with_origin) {
      const auto origin = gpu.origins.find(key.name);
      row.push_back(origin == gpu.origins.end() ? TableCell{NotApplicable{}}
                                                : TableCell{origin->second.to_string()});
    }
    row.push_back(std::string(key.description));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table difference_table(const GpuConfig& a, const GpuConfig& b) {
  Table table{{{"key", "key"}, {"a", a.id, true}, {"b", b.id, true}}, {}};
  for (const KeyInfo& key : gpu_keys()) {
    const std::string value_a = value_of(a, key.name), value_b = value_of(b, key.name);
    if (value_a != value_b) table.rows.push_back({std::string(key.name), value_a, value_b});
  }
  return table;
}

}  // namespace hwsim::lab
