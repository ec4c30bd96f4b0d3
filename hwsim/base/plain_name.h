#pragma once
// Names as people remember them.
#include <string>
#include <string_view>

namespace hwsim {

/// Lower case, without spaces, dashes and underscores: "GTX 980" and "gtx980" are one name.
std::string plain_name(std::string_view name);

}  // namespace hwsim
