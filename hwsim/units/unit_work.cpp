#include "hwsim/units/unit_work.h"

namespace hwsim {

std::string_view stream_name(Stream stream) {
  static constexpr std::array<std::string_view, kStreamCount> kNames = {
      "depth", "color", "texture", "storage", "vertex", "index", "constant", "shader", "other"};
  return kNames[index_of(stream)];
}

}  // namespace hwsim
