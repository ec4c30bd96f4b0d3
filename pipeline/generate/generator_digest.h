#pragma once
// The digest of the sources that generate scenes.
#include <string_view>

namespace hwsim::pipeline {

/// A hash of the generators' source files and of the compiler, 32 hex digits: part of the name of every
/// cached scene.
std::string_view generator_digest();

}  // namespace hwsim::pipeline
