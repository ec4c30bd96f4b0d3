// Tables as text, on paper of any width.
#include <fmt/format.h>

#include <algorithm>

#include "hwsim/base/printable.h"
#include "lab/base/table.h"

namespace hwsim::lab {
namespace {

constexpr std::size_t kGapColumns = 2, kNarrowestColumns = 8;

/// Bytes that start a character in UTF-8, which is the width of all that hwsim prints.
std::size_t display_columns(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

/// The first bytes that take no more than `columns`.
std::size_t bytes_of_columns(std::string_view text, std::size_t columns) {
  std::size_t at = 0;
  while (at < text.size() && columns > 0) {
    ++at;
    while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80) ++at;
    --columns;
  }
  return at;
}

/// Breaks at spaces; a longer word stays whole unless `hard`.
std::vector<std::string> wrap(const std::string& text, std::size_t columns, bool hard) {
  if (columns == 0 || display_columns(text) <= columns) return {text};
  std::vector<std::string> lines;
  std::string_view rest = text;
  while (display_columns(rest) > columns) {
    const std::size_t reach = bytes_of_columns(rest, columns);
    std::size_t end = rest.rfind(' ', reach);
    if (end == std::string_view::npos || end == 0) end = hard ? reach : rest.find(' ', reach);
    if (end == std::string_view::npos) break;
    lines.emplace_back(rest.substr(0, end));
    rest.remove_prefix(end);
    if (rest.starts_with(' ')) rest.remove_prefix(1);
  }
  lines.emplace_back(rest);
  return lines;
}

std::size_t longest_word(std::string_view text) {
  std::size_t longest = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    longest = std::max(longest, display_columns(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return longest;
}

/// What the cells of a column need.
struct Need {
  std::size_t title = 0, title_word = 0;  ///< the title in one line, and its longest word
  std::size_t cell = 0, cell_word = 0;
  bool has_value = false;
};

class TextWriter {
 public:
  TextWriter(const RowSource& rows, const TakeText& take, const TextLayout& layout)
      : source_(rows), take_(take), layout_(layout), needs_(rows.columns.size()) {}

  void write() {
    measure();
    for (std::size_t i = 0; i < needs_.size(); ++i)
      if (layout_.details || i == 0 || (needs_[i].has_value && !source_.columns[i].detail))
        shown_.push_back(i);
    fit();
    const std::vector<std::vector<std::size_t>> blocks = blocks_of_columns();
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      if (b > 0) take_("\n");
      write_block(blocks[b]);
    }
    if (layout_.rows > 0 && count_ > layout_.rows)
      take_(fmt::format("... {} more rows\n", count_ - layout_.rows));
  }

 private:
  void measure() {
    for (std::size_t i = 0; i < needs_.size(); ++i) {
      const std::string title =
          printable_line(source_.columns[i].title);  // a sweep's file names some of its columns
      needs_[i].title = display_columns(title);
      needs_[i].title_word = longest_word(title);
    }
    if (source_.each)
      source_.each([&](const std::vector<TableCell>& row) {
        ++count_;
        for (std::size_t i = 0; i < row.size(); ++i) take_need(row[i], source_.columns[i], needs_[i]);
      });
  }

  static void take_need(const TableCell& cell, const Column& column, Need& need) {
    const std::string text = text_of(cell);
    need.has_value = need.has_value || !(text.empty() || std::holds_alternative<NotApplicable>(cell));
    need.cell_word = std::max(need.cell_word, longest_word(text));
    for (const std::string& line : wrap(text, column.wrap_columns, false))
      need.cell = std::max(need.cell, display_columns(line));
  }

  std::size_t total(const std::vector<std::size_t>& columns) const {
    std::size_t sum = 0;
    for (const std::size_t i : columns) sum += widths_[i] + kGapColumns;
    return columns.empty() ? 0 : sum - kGapColumns;
  }

  /// As wide as the cells; where that is too wide, titles of several lines, then text of several lines.
  void fit() {
    for (const Need& need : needs_) widths_.push_back(std::max(need.title, need.cell));
    narrow_ = layout_.columns > 0 && total(shown_) > layout_.columns;
    if (!narrow_) return;
    for (std::size_t i = 0; i < needs_.size(); ++i)
      widths_[i] = std::max(needs_[i].title_word, needs_[i].cell);
    while (total(shown_) > layout_.columns) {
      const std::size_t excess = total(shown_) - layout_.columns;
      const auto spare = [&](std::size_t i) {
        const Need& need = needs_[i];
        const std::size_t least = std::max({need.title_word, need.cell_word, kNarrowestColumns});
        return source_.columns[i].right || widths_[i] <= least ? std::size_t{0} : widths_[i] - least;
      };
      const std::size_t most = *std::ranges::max_element(shown_, std::less{}, spare);
      if (spare(most) == 0) break;
      widths_[most] -= std::min(excess, spare(most));
    }
    const std::size_t key = shown_.front();
    widths_[key] = std::min(widths_[key], std::max(layout_.columns / 2, kNarrowestColumns));
    const std::size_t room = layout_.columns - std::min(layout_.columns, widths_[key] + kGapColumns);
    for (const std::size_t i : shown_)
      if (i != key) widths_[i] = std::min(widths_[i], std::max(room, kNarrowestColumns));
  }

  std::vector<std::vector<std::size_t>> blocks_of_columns() const {
    if (!narrow_) return {shown_};
    std::vector<std::vector<std::size_t>> blocks = {{shown_.front()}};
    for (std::size_t n = 1; n < shown_.size(); ++n) {
      std::vector<std::size_t> wider = blocks.back();
      wider.push_back(shown_[n]);
      const bool full = total(wider) > layout_.columns && blocks.back().size() > 1;
      if (full)
        blocks.push_back({shown_.front(), shown_[n]});
      else
        blocks.back() = std::move(wider);
    }
    return blocks;
  }

  std::vector<std::string> lines_of(const std::string& text, std::size_t column) const {
    return narrow_ ? wrap(text, widths_[column], true)
                   : wrap(text, source_.columns[column].wrap_columns, false);
  }

  void write_block(const std::vector<std::size_t>& columns) {
    std::vector<std::vector<std::string>> titles, rules;
    for (const std::size_t i : columns) {
      const std::string title = printable_line(source_.columns[i].title);
      titles.push_back(narrow_ ? wrap(title, widths_[i], true) : std::vector<std::string>{title});
      rules.push_back({std::string(widths_[i], '-')});
    }
    write_lines(columns, titles, false);
    write_lines(columns, rules, false);
    std::size_t written = 0;
    if (source_.each)
      source_.each([&](const std::vector<TableCell>& row) {
        if (layout_.rows > 0 && written++ >= layout_.rows) return;
        std::vector<std::vector<std::string>> cells;
        for (const std::size_t i : columns) cells.push_back(lines_of(text_of(row[i]), i));
        write_lines(columns, cells, true);
      });
  }

  void write_lines(const std::vector<std::size_t>& columns,
                   const std::vector<std::vector<std::string>>& cells, bool painted) {
    std::size_t height = 1;
    for (const auto& cell : cells) height = std::max(height, cell.size());
    std::string out;
    for (std::size_t line = 0; line < height; ++line) {
      std::string row;
      for (std::size_t n = 0; n < columns.size(); ++n)
        row += padded(line < cells[n].size() ? cells[n][line] : "", columns[n], painted) +
               std::string(kGapColumns, ' ');
      row.erase(row.find_last_not_of(' ') + 1);
      out += row + "\n";
    }
    take_(out);
  }

  std::string padded(const std::string& text, std::size_t column, bool painted) const {
    const std::size_t width = widths_[column];
    const std::string space(width - std::min(width, display_columns(text)), ' ');
    const std::string shown = painted && layout_.paint ? layout_.paint(source_.columns[column], text) : text;
    return source_.columns[column].right ? space + shown : shown + space;
  }

  const RowSource& source_;
  const TakeText& take_;
  const TextLayout& layout_;
  std::vector<Need> needs_;
  std::vector<std::size_t> shown_, widths_;
  std::size_t count_ = 0;
  bool narrow_ = false;
};

}  // namespace

void write_text(const RowSource& rows, const TakeText& take, const TextLayout& layout) {
  if (!rows.columns.empty()) TextWriter(rows, take, layout).write();
}

}  // namespace hwsim::lab
