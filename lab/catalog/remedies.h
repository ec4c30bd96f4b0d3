#pragma once
// How to go on after a message that does not say so itself.
#include <string_view>

namespace hwsim::lab {

/// What the user can do about any message of this code; empty for notes, which need nothing, and for codes
/// that do not exist.
std::string_view remedy_of(std::string_view code);

}  // namespace hwsim::lab
