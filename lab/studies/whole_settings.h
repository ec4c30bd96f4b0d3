#pragma once
// Whether what varies counts things: a range of numbers of ROPs goes in whole ones.
#include <string_view>

namespace hwsim::lab {

/// Whether a setting, by its path, takes whole numbers alone. False for a path that is none.
bool is_whole_setting(std::string_view path);

}  // namespace hwsim::lab
