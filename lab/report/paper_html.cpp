#include "lab/report/paper_html.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "lab/report/html.h"

namespace hwsim::lab {
namespace {

constexpr double kClosePct = 10.0, kNearPct = 20.0;

/// A line of the head: labels of one level, those that follow each other and are alike as one cell.
std::string head_line(const PaperTable& table, std::size_t level) {
  const auto alike = [&](std::size_t a, std::size_t b) {
    for (std::size_t i = 0; i <= level; ++i)
      if (table.columns[a][i] != table.columns[b][i]) return false;
    return true;
  };
  std::string html;
  for (std::size_t c = 0; c < table.columns.size();) {
    std::size_t end = c + 1;
    while (end < table.columns.size() && alike(c, end)) ++end;
    html += fmt::format("<th scope=\"colgroup\" colspan=\"{}\">{}</th>", end - c,
                        html_text(table.columns[c][level]));
    c = end;
  }
  return html;
}

std::string head_of(const PaperTable& table) {
  const std::size_t levels = table.columns.empty() ? 0 : table.columns.front().size();
  std::string html = "<thead>";
  for (std::size_t level = 0; level < levels; ++level) {
    html += "<tr>";
    if (level == 0) html += fmt::format("<th rowspan=\"{}\">{}</th>", levels, html_text(table.line_title));
    html += head_line(table, level) + "</tr>\n";
  }
  return html + "</thead>\n";
}

int decimals_of(const cost_models::Cell& cell) { return cell.unit == "ms" ? 2 : cell.unit == "mib" ? 1 : 0; }

const char* class_of(double error_pct) {
  const double size = std::abs(error_pct);
  return size <= kClosePct ? "close" : size <= kNearPct ? "near" : "far";
}

bool is_outside(const ReproducedRow& row) {
  return row.low && row.high && (row.cell.published < *row.low || row.cell.published > *row.high);
}

std::string title_of(const ReproducedRow& row) {
  std::string title = row.cell.row.id() + ", " + std::string(row_use_name(row.cell.use));
  if (row.low && row.high) title += fmt::format(", 90 % interval {:.2f} to {:.2f}", *row.low, *row.high);
  if (row.held_out) title += fmt::format(", {:.2f} by a fit without this scene", *row.held_out);
  if (!row.excluded_because.empty()) title += ": " + row.excluded_because;
  return title;
}

/// As it was printed, where that is a change and not the value itself.
std::string printed_of(const ReproducedRow& row) {
  const bool is_change = row.cell.row.quantity.starts_with("percent_change");
  return is_change ? fmt::format(" <small>(printed {} %)</small>", html_text(row.cell.row.printed))
                   : std::string();
}

std::string cell_of(const ReproducedRow& row) {
  const int decimals = decimals_of(row.cell);
  const std::string unit = row.cell.unit.empty() ? row.cell.row.quantity : row.cell.unit;
  if (!row.predicted || row.cell.published <= 0.0)
    return fmt::format("<span class=\"unpredicted\" title=\"{}\">{} <small>not predicted</small></span>",
                       html_text(title_of(row)), html_text(row.cell.row.printed));
  const double error_pct = 100.0 * (*row.predicted / row.cell.published - 1.0);
  const std::string text =
      fmt::format("{:.{}f} \u2192 {:.{}f}", row.cell.published, decimals, *row.predicted, decimals);
  return fmt::format("<span class=\"{}\" title=\"{}, {}\">{}{} <small>{:+.0f} %</small></span>",
                     class_of(error_pct), html_text(title_of(row)), html_text(unit),
                     is_outside(row) ? "<strong>" + text + "</strong>" : text, printed_of(row), error_pct);
}

/// The unit that all predicted values share; empty where they share none.
std::string unit_of(const PaperTable& table, const Reproduction& reproduction) {
  std::set<std::string> units;
  for (const PaperTable::Line& line : table.lines)
    for (const std::vector<std::size_t>& cell : line.cells)
      for (const std::size_t row : cell)
        if (reproduction.rows[row].predicted) units.insert(reproduction.rows[row].cell.unit);
  return units.size() == 1 ? *units.begin() : std::string();
}

}  // namespace

std::string html_paper_table(const PaperTable& table, const Reproduction& reproduction) {
  const std::string unit = unit_of(table, reproduction);
  std::string html =
      fmt::format("<div class=\"scroll\"><table class=\"paper\"><caption>{}</caption>{}<tbody>\n",
                  html_text(table.title + (unit.empty() ? "" : ", " + unit)), head_of(table));
  for (const PaperTable::Line& line : table.lines) {
    html += fmt::format("<tr><th scope=\"row\">{}</th>", html_text(line.label));
    for (const std::vector<std::size_t>& cell : line.cells) {
      html += "<td>";
      for (std::size_t i = 0; i < cell.size(); ++i)
        html += (i == 0 ? "" : "<br>") + cell_of(reproduction.rows[cell[i]]);
      html += "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string paper_notes(const Reproduction& reproduction) {
  std::map<std::string, std::size_t> reasons;
  for (const ReproducedRow& row : reproduction.rows)
    if (row.cell.use != cost_models::RowUse::claim && !row.excluded_because.empty())
      ++reasons[row.excluded_because];
  if (reasons.empty()) return {};
  std::string html = "<details><summary>Rows that are not fitted</summary><ul>";
  for (const auto& [reason, count] : reasons)
    html += fmt::format("<li>{} rows: {}</li>", count, html_text(reason));
  return html + "</ul></details>\n";
}

}  // namespace hwsim::lab
