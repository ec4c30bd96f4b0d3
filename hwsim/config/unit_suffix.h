#pragma once
// Keys end in their units: `core_clock_ghz` means `core_clock_mhz`, times 1000.
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "hwsim/config/toml_value.h"

namespace hwsim {

/// For a name that differs from one of `names` in its unit alone: "did you mean `core_clock_mhz`, in MHz:
/// 2600?" of `core_clock_ghz` = 2.6; without a value, how many of the one unit are one of the other. "" for
/// others.
std::string other_unit_hint(std::string_view name, const std::optional<TomlValue>& value,
                            std::span<const std::string> names);

}  // namespace hwsim
