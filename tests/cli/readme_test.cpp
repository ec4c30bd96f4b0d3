// The tables of README.md are what the program prints: each stands behind a comment that names its command.
// With HWSIM_WRITE_REFERENCE set, the test writes their rows (scripts/reference.sh).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "cli/program.h"
#include "support/places.h"

namespace hwsim::cli::test {
namespace {

using Row = std::vector<std::string>;
using MarkdownTable = std::vector<Row>;  ///< titles first, without the rule

Row cells_of(std::string line) {
  Row cells;
  line.erase(0, line.find('|') + 1);
  for (std::size_t bar = line.find('|'); bar != std::string::npos; bar = line.find('|')) {
    std::string cell = line.substr(0, bar);
    cell.erase(0, cell.find_first_not_of(' '));
    cell.erase(cell.find_last_not_of(' ') + 1);
    cells.push_back(cell);
    line.erase(0, bar + 1);
  }
  return cells;
}

bool is_rule(const Row& row) {
  return std::ranges::all_of(row, [](const std::string& cell) {
    return cell.find_first_not_of("-:") == std::string::npos && cell.size() >= 3;
  });
}

std::vector<MarkdownTable> tables_in(const std::string& text) {
  std::vector<MarkdownTable> tables;
  bool inside = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool row = line.starts_with("|");
    if (row && !inside) tables.emplace_back();
    if (row && !is_rule(cells_of(line))) tables.back().push_back(cells_of(line));
    inside = row;
  }
  return tables;
}

struct ShownTable {
  std::string command;
  MarkdownTable table;
};

std::string readme_path() { return hwsim::test::source_dir() + "/README.md"; }

std::string read_readme() {
  std::ostringstream text;
  text << std::ifstream(readme_path()).rdbuf();
  return text.str();
}

std::string lines_of(const MarkdownTable& table, std::size_t first) {
  std::string text;
  for (std::size_t i = first; i < table.size(); ++i) {
    text += "|";
    for (const std::string& cell : table[i]) text += " " + cell + " |";
    text += "\n";
  }
  return text;
}

/// The rows behind a comment's table; its titles and its rule stay.
void write_rows(const std::string& command, const MarkdownTable& table) {
  std::string text = read_readme();
  const std::size_t title = text.find("\n|", text.find("<!-- table: hwsim " + command)) + 1;
  const std::size_t rows = text.find('\n', text.find('\n', title) + 1) + 1;
  text.replace(rows, text.find("\n\n", rows) + 1 - rows, lines_of(table, 1));
  std::ofstream(readme_path()) << text;
}

std::vector<ShownTable> tables_of_readme() {
  std::ifstream file(readme_path());
  const std::string mark = "<!-- table: hwsim ", end = " -->";
  std::vector<ShownTable> shown;
  std::string text;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(mark)) {
      shown.push_back({line.substr(mark.size(), line.size() - mark.size() - end.size()), {}});
      text.clear();
    }
    text += line + "\n";
    if (!shown.empty() && line.empty() && shown.back().table.empty())
      if (const auto tables = tables_in(text); !tables.empty()) shown.back().table = tables.front();
  }
  return shown;
}

/// The columns of `printed` that `shown` has; empty where one is missing. Of two columns with one title the
/// first.
MarkdownTable with_columns_of(const MarkdownTable& shown, const MarkdownTable& printed) {
  MarkdownTable chosen(printed.size());
  for (const std::string& title : shown.front()) {
    const auto found = std::ranges::find(printed.front(), title);
    if (found == printed.front().end()) return {};
    const auto column = static_cast<std::size_t>(found - printed.front().begin());
    for (std::size_t i = 0; i < printed.size(); ++i) chosen[i].push_back(printed[i][column]);
  }
  return chosen;
}

TEST(Readme, TablesAreWhatTheirCommandsPrint) {
  const std::vector<ShownTable> shown = tables_of_readme();
  ASSERT_GE(shown.size(), 2u);
  const Workplace place;
  for (const ShownTable& each : shown) {
    ASSERT_GE(each.table.size(), 3u) << each.command;
    const Outcome outcome = place.hwsim(each.command + " --format md");
    ASSERT_EQ(outcome.status, 0) << each.command << "\n" << outcome.err;
    const std::vector<MarkdownTable> printed = tables_in(outcome.out);
    if (std::getenv("HWSIM_WRITE_REFERENCE") != nullptr) {
      for (const MarkdownTable& table : printed)
        if (const MarkdownTable chosen = with_columns_of(each.table, table); !chosen.empty())
          write_rows(each.command, chosen);
      continue;
    }
    EXPECT_TRUE(std::ranges::any_of(
        printed,
        [&](const MarkdownTable& table) { return with_columns_of(each.table, table) == each.table; }))
        << "scripts/reference.sh writes it anew: README.md does not show what `hwsim " << each.command
        << "` prints:\n"
        << outcome.out;
  }
}

}  // namespace
}  // namespace hwsim::cli::test
