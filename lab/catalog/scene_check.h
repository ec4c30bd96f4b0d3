#pragma once
// What scenes hold and what there is to say about them: for `scene check`.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "lab/base/table.h"

namespace hwsim::lab {

struct CheckedScenes {
  Table table{};                                 ///< a row a scene that loads
  std::vector<std::vector<Diagnostic>> notes{};  ///< for each row
  std::vector<Diagnostic> problems{};            ///< why scenes do not load
};

/// Loads each of them, files and generators. `folder` takes the generated ones.
CheckedScenes check_scenes(const std::vector<std::string>& names, const std::string& folder);

/// An object a scene, with its notes in full.
nlohmann::ordered_json to_json(const CheckedScenes& scenes);

}  // namespace hwsim::lab
