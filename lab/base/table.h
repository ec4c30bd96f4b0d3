#pragma once
// One table, four shapes: text, CSV, JSON, Markdown.
#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace hwsim::lab {

/// There is no such value here; never shown as 0.
struct NotApplicable {};
struct Real {
  double value = 0.0;
  int decimals = 2;  ///< in text and Markdown; CSV and JSON carry every digit
};
using TableCell = std::variant<NotApplicable, std::string, std::uint64_t, Real>;

struct Column {
  std::string id;     ///< CSV header and JSON key
  std::string title;  ///< text and Markdown
  bool right = false;
  std::size_t wrap_columns = 0;  ///< 0: as wide as its longest cell
  bool detail = false;           ///< left out where people read a first answer
};

struct Table {
  std::vector<Column> columns;
  std::vector<std::vector<TableCell>> rows;
};

using TakeRow = std::function<void(const std::vector<TableCell>&)>;

/// A table whose rows come one after another, as often as they are asked for: a million take no memory.
struct RowSource {
  std::vector<Column> columns;
  std::function<void(const TakeRow&)> each;  ///< none: no rows
};
RowSource rows_of(const Table& table);  ///< valid as long as the table
RowSource rows_of(Table&& table);       ///< keeps the table
Table collected(const RowSource& rows);

/// A cell as people read it; names from files are made safe for terminals.
std::string text_of(const TableCell& cell);

/// How a table stands on a screen.
struct TextLayout {
  std::size_t columns = 0;  ///< width of the screen; 0: as wide as the cells are
  std::size_t rows = 0;     ///< most rows; 0: all
  bool details = true;      ///< columns of details, and those without a value, too
  /// What is written in place of a cell's text, such as the text in a color; none: the text.
  std::function<std::string(const Column&, const std::string&)> paint{};
};

/// Takes the text piece by piece. Names from files are made safe for terminals.
using TakeText = std::function<void(std::string_view)>;
/// Asks for the rows twice, and once more for each block: what is wider than the screen is wrapped, then
/// stands in blocks below each other, each with the first column.
void write_text(const RowSource& rows, const TakeText& take, const TextLayout& layout = {});
void write_csv(const RowSource& rows, const TakeText& take);
void write_markdown(const RowSource& rows, const TakeText& take);
void write_json(const RowSource& rows, const TakeText& take);  ///< as to_json(), indented by two

std::string to_text(const Table& table, const TextLayout& layout = {});
/// RFC 4180: one header line, CRLF. A text that a spreadsheet would run begins with an apostrophe.
std::string to_csv(const Table& table);
std::string to_markdown(const Table& table);
nlohmann::ordered_json to_json(const Table& table);  ///< an array of objects

/// Columns are called by their keys; how many decimals are shown is lost. Throws nlohmann::json::exception
/// where there is no array of objects with equal keys.
Table table_from_json(const nlohmann::ordered_json& json);

/// Digits that read back to the same value.
std::string exact(double value);

}  // namespace hwsim::lab
