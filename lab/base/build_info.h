#pragma once
// What was built: version, commit, compiler, vector targets.
#include <string_view>

namespace hwsim::lab {

/// Changes whenever the same input may give other numbers.
inline constexpr int kModelVersion = 2;

struct BuildInfo {
  std::string_view version, commit, compiler, build_type, vector_targets;
};
BuildInfo build_info();

}  // namespace hwsim::lab
