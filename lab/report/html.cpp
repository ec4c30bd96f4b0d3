#include "lab/report/html.h"

#include <fmt/format.h>

#include "hwsim/base/printable.h"
#include "lab/base/json_text.h"

namespace hwsim::lab {
namespace {

std::string opened_cell(const Column& column, std::string_view data) {
  std::string text = column.right ? "<td class=\"n\"" : "<td";
  if (!data.empty()) text += fmt::format(" data-v=\"{}\"", data);
  return text + ">";
}

struct CellWriter {
  const Column& column;
  std::string operator()(const NotApplicable&) const { return opened_cell(column, "") + "n/a</td>"; }
  std::string operator()(const std::string& text) const {
    return opened_cell(column, "") + html_text(text) + "</td>";
  }
  std::string operator()(std::uint64_t count) const {
    return opened_cell(column, "") + fmt::format("{}</td>", count);
  }
  std::string operator()(const Real& real) const {
    return opened_cell(column, exact(real.value)) + fmt::format("{:.{}f}</td>", real.value, real.decimals);
  }
};

}  // namespace

std::string html_text(std::string_view text) {
  std::string safe;
  for (const char c : printable(text)) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string script_json(const nlohmann::ordered_json& json) {
  std::string safe;
  for (const char c : json_text(json, -1)) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

std::string html_table(const Table& table, std::string_view caption) {
  std::string html =
      fmt::format("<div class=\"scroll\"><table><caption>{}</caption><thead><tr>", html_text(caption));
  for (const Column& column : table.columns)
    html += fmt::format("<th scope=\"col\"{} data-id=\"{}\">{}</th>", column.right ? " class=\"n\"" : "",
                        html_text(column.id), html_text(column.title));
  html += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) html += std::visit(CellWriter{table.columns[i]}, row[i]);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace hwsim::lab
