#pragma once
// What was built: version, commit, compiler, vector targets.
#include <string_view>

namespace hwsim::lab {

/// Changes whenever the same input may give other numbers: a hash of all sources that a prediction depends on
/// and of the compiler, made at build time.
std::string_view model_version();

struct BuildInfo {
  std::string_view version, commit, compiler, build_type, vector_targets;
};
BuildInfo build_info();

}  // namespace hwsim::lab
