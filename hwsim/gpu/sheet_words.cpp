#include "hwsim/gpu/sheet_words.h"

#include <algorithm>
#include <array>

#include "hwsim/config/assign.h"
#include "hwsim/config/unit_suffix.h"

namespace hwsim {
namespace {

constexpr double kKibPerMib = 1024.0;

constexpr std::array<SheetWord, 14> kWords = {{{"rops", "crop_units"},
                                               {"tmus", "tex_bilinear_per_clk"},
                                               {"texture_units", "tex_bilinear_per_clk"},
                                               {"sms", "shader_cores"},
                                               {"cus", "shader_cores"},
                                               {"compute_units", "shader_cores"},
                                               {"gpcs", "raster_engines"},
                                               {"shader_engines", "raster_engines"},
                                               {"clock_mhz", "core_clock_mhz"},
                                               {"bandwidth_gb_s", "dram_bandwidth_gb_s"},
                                               {"l2_kib", "l2_size_kib"},
                                               {"l2_mib", "l2_size_kib", kKibPerMib},
                                               {"infinity_cache", "llc_size_kib", kKibPerMib},
                                               {"infinity_cache_mib", "llc_size_kib", kKibPerMib}}};

}  // namespace

std::span<const SheetWord> sheet_words() { return kWords; }

const SheetWord* find_sheet_word(std::string_view word) {
  const auto found = std::ranges::find(kWords, word, &SheetWord::word);
  return found == kWords.end() ? nullptr : &*found;
}

std::vector<std::string> sheet_word_names() {
  std::vector<std::string> names;
  for (const SheetWord& word : sheet_words()) names.emplace_back(word.word);
  return names;
}

void translate(const SheetWord& word, TomlEntry& entry) {
  entry.path = word.key;
  if (word.factor == 1.0) return;
  if (entry.value) entry.value = scaled(*entry.value, word.factor);
  if (entry.interval)
    for (double& end : *entry.interval) end *= word.factor;
}

std::string unknown_key_hint(std::span<const Key> keys, const TomlEntry& entry, const std::string& near_key) {
  const std::vector<std::string> words = sheet_word_names();
  std::vector<std::string> names;
  for (const Key& key : keys) names.emplace_back(key.info.name);
  names.insert(names.end(), words.begin(), words.end());
  std::string hint = other_unit_hint(entry.path, entry.value, names);
  if (hint.empty()) hint = near_key;
  return hint.empty() ? did_you_mean(entry.path, words) : hint;
}

}  // namespace hwsim
