#pragma once
// Values as a user writes them: on the right of `--set path=value`, in a sweep, in a file.
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

namespace hwsim {

using TomlValue = std::variant<bool, std::int64_t, double, std::string>;

/// A TOML scalar. Text that is no TOML value is taken as a bare string ("none", "agaa:c=2"); an array, a
/// table, a date or an unfinished string is an InputError C021.
TomlValue parse_toml_value(std::string_view text);

/// `value` as TOML; reals in the shortest form that reads back to the same bits.
std::string to_toml(const TomlValue& value);

/// "boolean", "integer", "real number", "text": as messages name it.
std::string_view type_name(const TomlValue& value);

/// One `--set`: path "gpu.core_clock_mhz", value "1500".
struct Assignment {
  std::string path;
  std::string value;
  std::string group() const { return path.substr(0, path.find('.')); }
};

/// Splits "path=value" at the first '='; InputError C020 when there is none or the path has no group.
Assignment parse_assignment(std::string_view text);

}  // namespace hwsim
