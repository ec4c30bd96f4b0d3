#include "lab/base/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace hwsim::lab {
namespace {

std::string text_of(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* count = std::get_if<std::uint64_t>(&cell)) return std::to_string(*count);
  if (const auto* real = std::get_if<Real>(&cell)) return fmt::format("{:.{}f}", real->value, real->decimals);
  return "n/a";
}

std::string csv_of(const Cell& cell) {
  if (const auto* real = std::get_if<Real>(&cell)) return exact(real->value);
  std::string text = text_of(cell);
  if (text.find_first_of("\",\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// Bytes that start a character in UTF-8, which is the width of all that hwsim prints.
size_t display_columns(std::string_view text) {
  return static_cast<size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string padded(const std::string& text, size_t columns, bool right) {
  const std::string space(columns - std::min(columns, display_columns(text)), ' ');
  return right ? space + text : text + space;
}

/// Breaks at spaces; a longer word stays whole.
std::vector<std::string> wrap(const std::string& text, size_t columns) {
  if (columns == 0 || text.size() <= columns) return {text};
  std::vector<std::string> lines;
  size_t start = 0;
  while (text.size() - start > columns) {
    size_t space = text.rfind(' ', start + columns);
    if (space == std::string::npos || space <= start) space = text.find(' ', start + columns);
    if (space == std::string::npos) break;
    lines.push_back(text.substr(start, space - start));
    start = space + 1;
  }
  lines.push_back(text.substr(start));
  return lines;
}

Cell cell_from_json(const nlohmann::ordered_json& value) {
  if (value.is_null()) return NotApplicable{};
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  if (value.is_number()) return Real{value.get<double>()};
  return value.get<std::string>();
}

void append_row(std::string& out, const Table& table, const std::vector<std::vector<std::string>>& cells,
                const std::vector<size_t>& widths) {
  size_t height = 1;
  for (const auto& cell : cells) height = std::max(height, cell.size());
  for (size_t line = 0; line < height; ++line) {
    std::string row;
    for (size_t i = 0; i < cells.size(); ++i)
      row += padded(line < cells[i].size() ? cells[i][line] : "", widths[i], table.columns[i].right) + "  ";
    row.erase(row.find_last_not_of(' ') + 1);
    out += row + "\n";
  }
}

}  // namespace

std::string exact(double value) { return fmt::format("{}", value); }

std::string to_text(const Table& table) {
  std::vector<std::vector<std::vector<std::string>>> rows;
  std::vector<size_t> widths;
  for (const Column& column : table.columns) widths.push_back(display_columns(column.title));
  for (const auto& row : table.rows) {
    auto& cells = rows.emplace_back();
    for (size_t i = 0; i < row.size(); ++i) {
      cells.push_back(wrap(text_of(row[i]), table.columns[i].wrap_columns));
      for (const std::string& line : cells.back()) widths[i] = std::max(widths[i], display_columns(line));
    }
  }
  std::string out;
  std::vector<std::vector<std::string>> titles, rules;
  for (size_t i = 0; i < widths.size(); ++i) {
    titles.push_back({table.columns[i].title});
    rules.push_back({std::string(widths[i], '-')});
  }
  append_row(out, table, titles, widths);
  append_row(out, table, rules, widths);
  for (const auto& cells : rows) append_row(out, table, cells, widths);
  return out;
}

std::string to_csv(const Table& table) {
  std::string out;
  for (size_t i = 0; i < table.columns.size(); ++i) out += (i ? "," : "") + csv_of(table.columns[i].id);
  out += "\r\n";
  for (const auto& row : table.rows) {
    for (size_t i = 0; i < row.size(); ++i) out += (i ? "," : "") + csv_of(row[i]);
    out += "\r\n";
  }
  return out;
}

std::string to_markdown(const Table& table) {
  const auto escaped = [](std::string text) {
    for (size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
    return text;
  };
  std::string out, rule;
  for (const Column& column : table.columns) {
    out += "| " + escaped(column.title) + " ";
    rule += column.right ? "| ---: " : "| --- ";
  }
  out += "|\n" + rule + "|\n";
  for (const auto& row : table.rows) {
    for (const Cell& cell : row) out += "| " + escaped(text_of(cell)) + " ";
    out += "|\n";
  }
  return out;
}

nlohmann::ordered_json to_json(const Table& table) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const auto& row : table.rows) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (size_t i = 0; i < row.size(); ++i) {
      auto& value = object[table.columns[i].id];
      if (const auto* text = std::get_if<std::string>(&row[i])) value = *text;
      if (const auto* count = std::get_if<std::uint64_t>(&row[i])) value = *count;
      if (const auto* real = std::get_if<Real>(&row[i])) value = real->value;
    }
    rows.push_back(std::move(object));
  }
  return rows;
}

Table table_from_json(const nlohmann::ordered_json& json) {
  Table table;
  if (!json.empty())
    for (const auto& [key, value] : json.at(0).items()) table.columns.push_back({key, key});
  for (const nlohmann::ordered_json& object : json) {
    std::vector<Cell>& row = table.rows.emplace_back();
    for (const Column& column : table.columns) row.push_back(cell_from_json(object.at(column.id)));
  }
  return table;
}

}  // namespace hwsim::lab
