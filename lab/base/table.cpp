#include "lab/base/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "hwsim/base/printable.h"
#include "lab/base/json_text.h"

namespace hwsim::lab {
namespace {

bool is_number(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// Spreadsheets run a cell that begins like a formula; behind an apostrophe it is text to them
/// (https://owasp.org/www-community/attacks/CSV_Injection).
std::string as_text_for_spreadsheets(std::string text) {
  const bool is_formula =
      !text.empty() && std::string_view("=+-@\t\r").find(text[0]) != std::string_view::npos;
  return is_formula && !is_number(text) ? "'" + text : text;
}

std::string csv_of(const TableCell& cell) {
  if (const auto* real = std::get_if<Real>(&cell)) return exact(real->value);
  const auto* own = std::get_if<std::string>(&cell);
  const std::string text = own ? as_text_for_spreadsheets(printable(*own)) : text_of(cell);
  if (text.find_first_of("\",\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

TableCell cell_from_json(const nlohmann::ordered_json& value) {
  if (value.is_null()) return NotApplicable{};
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  if (value.is_number()) return Real{value.get<double>()};
  return value.get<std::string>();
}

std::string escaped_for_markdown(std::string text) {
  for (size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

nlohmann::ordered_json to_json(const std::vector<TableCell>& row, const std::vector<Column>& columns) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (size_t i = 0; i < row.size(); ++i) {
    auto& value = object[columns[i].id];
    if (const auto* text = std::get_if<std::string>(&row[i])) value = *text;
    if (const auto* count = std::get_if<std::uint64_t>(&row[i])) value = *count;
    if (const auto* real = std::get_if<Real>(&row[i])) value = real->value;
  }
  return object;
}

using Write = void (*)(const RowSource&, const TakeText&);
std::string written(Write write, const Table& table) {
  std::string out;
  write(rows_of(table), [&out](std::string_view text) { out += text; });
  return out;
}

}  // namespace

std::string text_of(const TableCell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return printable_line(*text);
  if (const auto* count = std::get_if<std::uint64_t>(&cell)) return std::to_string(*count);
  if (const auto* real = std::get_if<Real>(&cell)) return fmt::format("{:.{}f}", real->value, real->decimals);
  return "n/a";
}

std::string exact(double value) { return fmt::format("{}", value); }

RowSource rows_of(const Table& table) {
  return {table.columns, [&table](const TakeRow& take) {
            for (const auto& row : table.rows) take(row);
          }};
}

RowSource rows_of(Table&& table) {
  const auto kept = std::make_shared<const Table>(std::move(table));
  return {kept->columns, [kept](const TakeRow& take) {
            for (const auto& row : kept->rows) take(row);
          }};
}

Table collected(const RowSource& rows) {
  Table table{rows.columns, {}};
  if (rows.each) rows.each([&](const std::vector<TableCell>& row) { table.rows.push_back(row); });
  return table;
}

void write_csv(const RowSource& rows, const TakeText& take) {
  std::string header;
  for (const Column& column : rows.columns) header += (header.empty() ? "" : ",") + csv_of(column.id);
  take(header + "\r\n");
  if (!rows.each) return;
  rows.each([&](const std::vector<TableCell>& row) {
    std::string line;
    for (size_t i = 0; i < row.size(); ++i) line += (i ? "," : "") + csv_of(row[i]);
    take(line + "\r\n");
  });
}

void write_markdown(const RowSource& rows, const TakeText& take) {
  std::string titles, rule;
  for (const Column& column : rows.columns) {
    titles += "| " + escaped_for_markdown(printable_line(column.title)) + " ";
    rule += column.right ? "| ---: " : "| --- ";
  }
  take(titles + "|\n" + rule + "|\n");
  if (!rows.each) return;
  rows.each([&](const std::vector<TableCell>& row) {
    std::string line;
    for (const TableCell& cell : row) line += "| " + escaped_for_markdown(text_of(cell)) + " ";
    take(line + "|\n");
  });
}

void write_json(const RowSource& rows, const TakeText& take) {
  bool first = true;
  if (rows.each)
    rows.each([&](const std::vector<TableCell>& row) {
      std::string text = json_text(to_json(row, rows.columns));
      text.pop_back();  // its line end
      for (size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 3) text.insert(at + 1, "  ");
      take((first ? "[\n  " : ",\n  ") + text);
      first = false;
    });
  take(first ? "[]\n" : "\n]\n");
}

std::string to_text(const Table& table, const TextLayout& layout) {
  std::string out;
  write_text(
      rows_of(table), [&out](std::string_view text) { out += text; }, layout);
  return out;
}
std::string to_csv(const Table& table) { return written(write_csv, table); }
std::string to_markdown(const Table& table) { return written(write_markdown, table); }

nlohmann::ordered_json to_json(const Table& table) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const auto& row : table.rows) rows.push_back(to_json(row, table.columns));
  return rows;
}

Table table_from_json(const nlohmann::ordered_json& json) {
  Table table;
  if (!json.empty())
    for (const auto& [key, value] : json.at(0).items()) table.columns.push_back({key, key});
  for (const nlohmann::ordered_json& object : json) {
    std::vector<TableCell>& row = table.rows.emplace_back();
    for (const Column& column : table.columns) row.push_back(cell_from_json(object.at(column.id)));
  }
  return table;
}

}  // namespace hwsim::lab
