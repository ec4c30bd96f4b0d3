#pragma once
// The digest of the sources that a trace depends on.
#include <string_view>

namespace hwsim::algos {

/// A hash of the sources that decide what is emulated and counted, made at build time: part of the key of
/// cached traces, so that no trace outlives the code that made it. A version number would have to be
/// remembered.
std::string_view source_digest();

}  // namespace hwsim::algos
