#pragma once
// What a command prints: one table, in each of the shapes that were asked for.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cli/arguments/command.h"
#include "lab/base/table.h"

namespace hwsim::cli {

/// Text and tables, one below the other.
class Passage {
 public:
  Passage() = default;
  Passage(std::string text) { add(std::move(text)); }
  Passage(const char* text) { add(std::string(text)); }
  Passage& add(std::string text) {
    parts_.emplace_back(std::move(text));
    return *this;
  }
  Passage& add(Table table) {
    parts_.emplace_back(std::move(table));
    return *this;
  }
  const std::vector<std::variant<std::string, Table>>& parts() const { return parts_; }

 private:
  std::vector<std::variant<std::string, Table>> parts_;
};

/// `json` is what JSON shows; text and the others come from the table. `heading` stands above and `footing`
/// below the table in text and Markdown.
struct Answer {
  Table table{};
  Passage heading{}, footing{};
  const nlohmann::ordered_json* json = nullptr;  ///< none: to_json(table)
  /// On a terminal, and without --verbose: no more rows than fit, no details, no footing.
  bool one_screen = false;
};

/// Writes to standard output. Throws InputError U010 when it cannot be written. What nobody reads any more is
/// dropped, as in `hwsim list gpus | head -1`: the reader had enough, and the work goes on.
void write_output(std::string_view text);

/// Writes each requested shape, to standard output or to its file. On a terminal tables are as wide as it,
/// and words that say how far an answer holds have colors. Throws InputError U010.
void print(const Answer& answer, const CommonArguments& options);

/// The same of rows that come one after another. Standard output needs no more memory for more of them.
void print_rows(const lab::RowSource& rows, const CommonArguments& options);

}  // namespace hwsim::cli
