#include "lab/studies/paper_layout.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

#include "hwsim/base/csv.h"
#include "lab/base/messages.h"

namespace hwsim::lab {
namespace {

using cost_models::PublishedRow;
using Labels = std::vector<std::string>;

struct Layout {
  std::string title{"all that is printed"}, cut{};
  Labels rows{"scene", "view"}, columns{"gpu", "msaa", "method", "lighting", "pass", "quantity"};
};

Labels words_of(const std::string& text) {
  std::istringstream stream(text);
  Labels words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::string with_blanks(std::string text) {
  std::ranges::replace(text, '_', ' ');
  return text;
}

std::string without(std::string text, const std::string& part) {
  const std::size_t at = part.empty() ? std::string::npos : text.find(part);
  return at == std::string::npos ? text : text.erase(at, part.size());
}

/// What a row says of a field, as a table's head would.
std::string label_of(const PublishedRow& row, const std::string& field, const Layout& layout) {
  if (field == "method") return without(row.technique, layout.cut) + row.surfaces;
  if (field == "msaa") return row.msaa.empty() ? "" : row.msaa + "x";
  if (field == "quantity") return row.quantity == "time_ms" ? "ms" : with_blanks(row.quantity);
  static const std::map<std::string, std::string PublishedRow::*> kFields = {
      {"scene", &PublishedRow::scene},       {"view", &PublishedRow::view}, {"gpu", &PublishedRow::gpu},
      {"lighting", &PublishedRow::lighting}, {"pass", &PublishedRow::pass}, {"note", &PublishedRow::note}};
  const auto found = kFields.find(field);
  if (found == kFields.end())
    fail("M001", "`" + field + "` in mapping/layout.csv is no field of a published row", "",
         "scene, view, gpu, msaa, method, lighting, pass, quantity, note");
  return with_blanks(row.*found->second);
}

Labels labels_of(const PublishedRow& row, const Labels& fields, const Layout& layout) {
  Labels labels;
  for (const std::string& field : fields) labels.push_back(label_of(row, field, layout));
  return labels;
}

std::string joined(const Labels& words, const char* between) {
  std::string text;
  for (const std::string& word : words)
    if (!word.empty()) text += (text.empty() ? "" : between) + word;
  return text;
}

class Layouts {
 public:
  explicit Layouts(const std::string& published_dir)
      : file_(read_csv((std::filesystem::path(published_dir) / "mapping" / "layout.csv").string())) {}

  /// The line of the file that a row belongs to, or none.
  std::size_t index_of(const PublishedRow& row) const {
    for (std::size_t i = 0; i < file_.rows.size(); ++i) {
      const Labels quantities = words_of(text(i, "quantities"));
      const bool taken =
          quantities.front() == "*" || std::ranges::find(quantities, row.quantity) != quantities.end();
      if (text(i, "table") == row.table && taken) return i;
    }
    return file_.rows.size();
  }

  Layout at(std::size_t i) const {
    if (i >= file_.rows.size()) return {};
    return {text(i, "title"), text(i, "cut"), words_of(text(i, "rows")), words_of(text(i, "columns"))};
  }

 private:
  const std::string& text(std::size_t line, std::string_view column) const {
    return file_.rows[line][file_.column(column)];
  }
  CsvFile file_;
};

/// Columns of one outer label stand together, in the order in which they first come.
void group(std::vector<Labels>& columns) {
  std::vector<std::map<std::string, std::size_t>> ranks(columns.empty() ? 0 : columns.front().size());
  for (std::size_t level = 0; level < ranks.size(); ++level)
    for (const Labels& column : columns) ranks[level].emplace(column[level], ranks[level].size());
  std::ranges::stable_sort(columns, std::less{}, [&](const Labels& column) {
    std::vector<std::size_t> place;
    for (std::size_t level = 0; level < ranks.size(); ++level)
      place.push_back(ranks[level].at(column[level]));
    return place;
  });
}

template <class Value>
std::size_t place_of(const std::vector<Value>& values, const Value& value) {
  return static_cast<std::size_t>(std::ranges::find(values, value) - values.begin());
}

PaperTable table_of(const std::vector<std::size_t>& members, const Reproduction& reproduction,
                    const Layout& layout) {
  const auto row_of = [&](std::size_t i) -> const PublishedRow& { return reproduction.rows[i].cell.row; };
  const PublishedRow& first = row_of(members.front());
  PaperTable table{.name = first.table,
                   .title = first.document + ", " + layout.title,
                   .line_title = joined(layout.rows, ", ")};
  std::vector<std::string> lines;
  for (const std::size_t i : members) {
    const Labels column = labels_of(row_of(i), layout.columns, layout);
    if (place_of(table.columns, column) == table.columns.size()) table.columns.push_back(column);
    const std::string line = joined(labels_of(row_of(i), layout.rows, layout), " ");
    if (place_of(lines, line) == lines.size()) lines.push_back(line);
  }
  group(table.columns);
  for (const std::string& line : lines)
    table.lines.push_back({line, std::vector<std::vector<std::size_t>>(table.columns.size())});
  for (const std::size_t i : members) {
    const std::string line = joined(labels_of(row_of(i), layout.rows, layout), " ");
    const Labels column = labels_of(row_of(i), layout.columns, layout);
    table.lines[place_of(lines, line)].cells[place_of(table.columns, column)].push_back(i);
  }
  return table;
}

}  // namespace

std::vector<PaperTable> paper_tables(const Reproduction& reproduction, const std::string& published_dir) {
  const Layouts layouts(published_dir);
  std::vector<std::pair<std::string, std::size_t>> keys;
  std::vector<std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < reproduction.rows.size(); ++i) {
    const cost_models::Cell& cell = reproduction.rows[i].cell;
    if (cell.use == cost_models::RowUse::claim) continue;
    const std::pair key(cell.row.table, layouts.index_of(cell.row));
    const std::size_t at = place_of(keys, key);
    if (at == keys.size()) keys.push_back(key), members.emplace_back();
    members[at].push_back(i);
  }
  std::vector<PaperTable> tables;
  for (std::size_t i = 0; i < keys.size(); ++i)
    tables.push_back(table_of(members[i], reproduction, layouts.at(keys[i].second)));
  return tables;
}

}  // namespace hwsim::lab
