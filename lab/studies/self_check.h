#pragma once
// Whether this hwsim works where it is: its files, its image module, its cache, and a small simulation.
#include <string>
#include <vector>

#include "lab/base/table.h"
#include "lab/point/session.h"

namespace hwsim::lab {

struct SelfCheck {
  std::string name{};
  bool ok = true;
  double wall_ms = 0.0;
  std::string detail{};                ///< what was found, or why it failed
  std::vector<Diagnostic> problems{};  ///< what is wrong with the files that were read
};

/// Each check, whatever the others say.
std::vector<SelfCheck> check_itself(Session& session);

Table self_check_table(const std::vector<SelfCheck>& checks);

}  // namespace hwsim::lab
