#pragma once
// Digests of the sources that a trace and a reference depend on.
#include <string_view>

namespace hwsim::algos {

/// A hash of the sources that decide what is emulated and counted, made at build time: part of the key of
/// cached traces, so that no trace outlives the code that made it. A version number would have to be
/// remembered.
std::string_view source_digest();

/// The same of the ray-traced references, for the key of cached ones.
std::string_view reference_digest();

}  // namespace hwsim::algos
