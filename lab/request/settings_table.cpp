#include "lab/request/settings_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "hwsim/gpu/gpu_keys.h"
#include "lab/request/request.h"

namespace hwsim::lab {
namespace {

std::string range_of(const KeySlot& slot, const KeyInfo& key, std::string_view choices) {
  if (!choices.empty()) {
    std::string words(choices);
    std::ranges::replace(words, '|', ' ');
    return words;
  }
  if (std::holds_alternative<bool*>(slot)) return "true false";
  if (std::holds_alternative<std::string*>(slot)) return "text";
  return fmt::format("{:g} to {:g}", key.low, key.high);
}

void add_fields(Table& table, const std::vector<Field>& fields) {
  for (const Field& field : fields)
    if (!field.info.group.empty())
      table.rows.push_back({fmt::format("{}.{}", field.info.group, field.info.key.name),
                            range_of(field.slot, field.info.key, field.info.choices),
                            std::string(field.info.key.description)});
}

void add_keys(Table& table, const std::vector<Key>& keys) {
  for (const Key& key : keys)
    table.rows.push_back({fmt::format("gpu.{}", key.info.name), range_of(key.slot, key.info, {}),
                          std::string(key.info.description)});
}

}  // namespace

Table settings_table() {
  Table table{{{"path", "path"}, {"range", "range"}, {"description", "meaning", false, 72}}, {}};
  View view;
  Settings settings;
  add_fields(table, fields_of(view));
  add_fields(table, fields_of(settings));
  GpuConfig gpu;
  add_keys(table, keys_of(static_cast<GpuValues<double>&>(gpu)));
  add_keys(table, keys_of(gpu.features));
  add_keys(table, keys_of(gpu.functional));
  return table;
}

}  // namespace hwsim::lab
