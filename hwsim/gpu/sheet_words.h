#pragma once
// Words of data sheets that GPU files and `--set gpu.` take in place of keys: "rops" for crop_units.
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hwsim/config/key.h"
#include "hwsim/config/toml_file.h"

namespace hwsim {

struct SheetWord {
  std::string_view word, key;
  double factor = 1.0;  ///< from the sheet's unit to the key's
};

std::span<const SheetWord> sheet_words();

std::vector<std::string> sheet_word_names();

/// The entry under the key that the word stands for, in the key's unit.
void translate(const SheetWord& word, TomlEntry& entry);

/// Null for what is no such word.
const SheetWord* find_sheet_word(std::string_view word);

/// What an unknown key may mean: a key or word of another unit with the value in it, else the key that is
/// near to it (`near_key`, as a hint), else a word.
std::string unknown_key_hint(std::span<const Key> keys, const TomlEntry& entry, const std::string& near_key);

}  // namespace hwsim
