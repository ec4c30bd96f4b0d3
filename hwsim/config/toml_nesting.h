#pragma once
// A look at TOML text before it is parsed: the parser calls itself for every level of nesting.
#include <optional>
#include <string>
#include <string_view>

namespace hwsim {

/// Levels that TOML text may nest: parts of a dotted key, and arrays and tables in each other.
inline constexpr int kTomlLevelsMax = 16;

struct TomlNesting {
  int line = 1, column = 1;  ///< from 1, where the level begins that is one too many
  std::string what;          ///< "a key of more than 16 parts", "more than 16 arrays or tables in each other"
};

/// The first place where the text nests deeper than kTomlLevelsMax; none where it does not. Text that is not
/// TOML may be taken either way: the parser says what is wrong with it.
std::optional<TomlNesting> too_deep(std::string_view text);

}  // namespace hwsim
