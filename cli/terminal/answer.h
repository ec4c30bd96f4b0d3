#pragma once
// What a command prints: one table, in each of the shapes that were asked for.
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cli/arguments/options.h"
#include "lab/base/table.h"

namespace hwsim::cli {

/// `json` is what JSON shows; text and the others come from the table. `heading` stands above and `footing`
/// below the table in text and Markdown.
struct Answer {
  Table table{};
  std::string heading{}, footing{};
  const nlohmann::ordered_json* json = nullptr;  ///< none: to_json(table)
};

/// Writes each requested shape, to standard output or to its file.
void print(const Answer& answer, const CommonOptions& options);

}  // namespace hwsim::cli
