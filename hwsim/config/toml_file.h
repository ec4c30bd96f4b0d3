#pragma once
// A TOML file as a flat list of entries with their places. The only other user of toml++ is toml_value.cpp:
// its header is slow to compile.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "hwsim/config/toml_value.h"

namespace hwsim {

/// A value of a file with what it says about its origin.
struct TomlEntry {
  std::string path;                ///< "features.float_atomics"
  std::optional<TomlValue> value;  ///< none: an array, a date, a table without `value`
  std::string found_type;          ///< for messages, where there is no value
  SourcePlace key_place;
  SourcePlace value_place;
  std::string provenance;  ///< as written; empty when absent
  SourcePlace provenance_place;
  std::string source;
  std::optional<std::array<double, 2>> interval;
};

struct TomlFile {
  std::string path;
  std::vector<TomlEntry> entries;  ///< in file order
};

/// Reads and flattens a file. Values may be plain or tables {value, provenance, source, interval}. Syntax
/// errors and malformed tables go to `problems`; a file that cannot be read is C010 there.
TomlFile read_toml_file(const std::string& path, std::vector<Diagnostic>& problems);

}  // namespace hwsim
