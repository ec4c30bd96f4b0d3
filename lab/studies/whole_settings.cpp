#include "lab/studies/whole_settings.h"

#include <algorithm>
#include <vector>

#include "algos/techniques.h"
#include "hwsim/config/assign.h"
#include "hwsim/gpu/gpu_keys.h"
#include "hwsim/gpu/sheet_words.h"
#include "lab/request/request.h"

namespace hwsim::lab {
namespace {

bool is_whole_of_gpu(std::string_view name) {
  const SheetWord* const word = find_sheet_word(name);
  if (word && word->factor != 1.0) return false;  // 1.5 MiB are whole KiB
  GpuConfig gpu;
  const std::vector<Key> keys = keys_of(gpu);
  const Key* const key = find_key(keys, word ? word->key : name);
  return key && (std::holds_alternative<int*>(key->slot) || key->info.has(kWhole));
}

/// Where every technique that has the parameter counts things by it.
bool is_whole_of_techniques(std::string_view name) {
  bool any = false;
  for (const algos::TechniqueInfo& technique : algos::techniques())
    for (const algos::OptionInfo& option : technique.options) {
      if (option.name != name) continue;
      if (!option.whole) return false;
      any = true;
    }
  return any;
}

bool is_whole_of_view(std::string_view name) {
  View view;
  return std::ranges::any_of(fields_of(view), [&](const Field& field) {
    return field.info.group == "scene" && field.info.key.name == name &&
           std::holds_alternative<int*>(field.slot);
  });
}

}  // namespace

bool is_whole_setting(std::string_view path) {
  const std::size_t dot = path.find('.');
  if (dot == std::string_view::npos) return false;
  const std::string_view group = path.substr(0, dot), name = path.substr(dot + 1);
  if (group == "gpu") return is_whole_of_gpu(name);
  return group == "technique" ? is_whole_of_techniques(name) : group == "scene" && is_whole_of_view(name);
}

}  // namespace hwsim::lab
