#include "hwsim/base/file_name.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace hwsim {

bool has_extension(std::string_view path, std::string_view extension) {
  if (path.size() <= extension.size()) return false;
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return std::equal(extension.begin(), extension.end(),
                    path.end() - static_cast<std::ptrdiff_t>(extension.size()), same);
}

}  // namespace hwsim
