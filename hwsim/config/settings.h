#pragma once
// `--set` for any group of settings whose struct has a `describe`: technique, emulator, timing.
#include <span>
#include <string_view>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "hwsim/config/key.h"
#include "hwsim/config/toml_value.h"

namespace hwsim {

/// Applies those of `sets` whose group is `group` to `keys`, and appends what is wrong with them to
/// `problems`.
void apply_settings(std::string_view group, std::span<const Key> keys, std::span<const Assignment> sets,
                    std::vector<Diagnostic>& problems);

/// The groups that some part of the program reads; any other is InputError C020 with the nearest name.
void check_groups(std::span<const Assignment> sets, std::span<const std::string> groups);

}  // namespace hwsim
