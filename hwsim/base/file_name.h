#pragma once
// What a file's name says about it.
#include <string_view>

namespace hwsim {

/// Whether the name ends in `extension` (".glb"), in any case: cameras and old systems write .GLB. A name
/// that is nothing else has no extension.
bool has_extension(std::string_view path, std::string_view extension);

}  // namespace hwsim
