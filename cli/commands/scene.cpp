#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
#include "lab/catalog/scene_check.h"

namespace hwsim::cli {
namespace {

/// One line a property reads better than one line a scene of fifteen columns.
Table transposed(const Table& table) {
  Table result{{{"property", "property"}}, {}};
  for (size_t row = 0; row < table.rows.size(); ++row)
    result.columns.push_back({fmt::format("scene_{}", row), "", true});
  for (size_t column = 0; column < table.columns.size(); ++column) {
    auto& line = result.rows.emplace_back();
    line.push_back(table.columns[column].title);
    for (const auto& row : table.rows) line.push_back(row[column]);
  }
  return result;
}

bool wants_lines(const CommonArguments& options) {
  return options.formats.empty() || options.formats.front().format == OutputFormat::table;
}

}  // namespace

ExitStatus scene_check(const SceneCheckArguments& options, Context& context) {
  const Lab lab(lab_options(options.common, context.log));
  const CheckedScenes scenes = check_scenes(options.scenes, lab.cache().directory(CacheFolder::scenes));
  for (const std::vector<Diagnostic>& notes : scenes.notes)
    for (const Diagnostic& note : notes) context.log.report(note);
  const nlohmann::ordered_json json = to_json(scenes);
  if (!scenes.table.rows.empty())
    print({.table = wants_lines(options.common) ? transposed(scenes.table) : scenes.table, .json = &json},
          options.common);
  if (!scenes.problems.empty()) throw InputError(scenes.problems);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
