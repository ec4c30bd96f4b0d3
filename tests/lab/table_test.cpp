// Tables as text, CSV, Markdown and JSON: what names from files may do there.
#include "lab/base/table.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace hwsim::lab {
namespace {

Table one_cell(const std::string& text) { return {{{"name", "name"}}, {{text}}}; }

std::string csv_cell(const std::string& text) {
  const std::string csv = to_csv(one_cell(text));
  const std::size_t begin = csv.find("\r\n") + 2;
  return csv.substr(begin, csv.size() - begin - 2);
}

TEST(Table, CellThatASpreadsheetWouldRunIsText) {
  EXPECT_EQ(csv_cell("=1+1"), "'=1+1");
  EXPECT_EQ(csv_cell("+cmd"), "'+cmd");
  EXPECT_EQ(csv_cell("-cmd"), "'-cmd");
  EXPECT_EQ(csv_cell("@SUM(A1)"), "'@SUM(A1)");
  EXPECT_EQ(csv_cell("=HYPERLINK(\"x\",\"y\")"), "\"'=HYPERLINK(\"\"x\"\",\"\"y\"\")\"");
  EXPECT_EQ(csv_cell("\t=1"), "'\t=1");
}

TEST(Table, NumbersAndPlainTextStayAsTheyAre) {
  for (const char* text : {"-5", "-0.25", "msaa8x", "a=b", "1-2"}) EXPECT_EQ(csv_cell(text), text);
  EXPECT_EQ(to_csv({{{"x", "x"}}, {{Real{-1.5}}}}), "x\r\n-1.5\r\n");
}

TEST(Table, HeaderIsTextToSpreadsheetsToo) { EXPECT_EQ(to_csv({{{"=1", "title"}}, {}}), "'=1\r\n"); }

TEST(Table, ControlCharactersReachNoOutput) {
  const std::string name =
      "a\x1b[2Jb\xc2\x9b"
      "c\xe2\x80\xae"
      "d\x7f\xff";
  const Table table = one_cell(name);
  std::string json;
  write_json(rows_of(table), [&json](std::string_view piece) { json += piece; });
  for (const std::string& text : {to_text(table), to_csv(table), to_markdown(table), json})
    for (const char* bad : {"\x1b", "\xc2\x9b", "\xe2\x80\xae", "\x7f", "\xff"})
      EXPECT_EQ(text.find(bad), std::string::npos) << text;
  const auto read_back = nlohmann::json::parse(json);
  EXPECT_EQ(read_back[0]["name"],
            "a\x1b[2Jb\xc2\x9b"
            "c\xe2\x80\xae"
            "d\x7f\xef\xbf\xbd")
      << "JSON keeps what is text";
}

TEST(Table, ControlCharactersOfTitlesReachNoOutput) {
  const Table table{{{"a\x1b[2J\x7f", "a\x1b[2J\x7f\n"}}, {{std::string("cell")}}};
  for (const std::string& text : {to_text(table), to_csv(table), to_markdown(table)})
    for (const char bad : {'\x1b', '\x7f'}) EXPECT_EQ(text.find(bad), std::string::npos) << text;
  const std::string shown = to_text(table);
  EXPECT_EQ(std::count(shown.begin(), shown.end(), '\n'), 3) << "title, rule, one row: " << shown;
}

TEST(Table, LineEndsInACellDoNotBreakTheTable) {
  const std::string text = to_text(one_cell("a\nb"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3) << "title, rule, one row: " << text;
}

Table wide() {
  return {{{"name", "name"},
           {"words", "a title of several words"},
           {"number", "number of things", true},
           {"empty", "empty"},
           {"detail", "a detail", true, 0, true},
           {"last", "the last column of all"}},
          {{std::string("first"), std::string("words that may stand in several lines"), std::uint64_t{12},
            NotApplicable{}, std::uint64_t{7}, std::string("end")}}};
}

std::size_t longest_line(const std::string& text) {
  std::size_t longest = 0;
  for (std::size_t begin = 0, end; begin < text.size(); begin = end + 1) {
    end = text.find('\n', begin);
    longest = std::max(longest, end - begin);
  }
  return longest;
}

TEST(TextLayout, TablesAreNoWiderThanTheScreen) {
  EXPECT_GT(longest_line(to_text(wide())), 80u);
  for (const std::size_t columns : {80u, 60u, 40u, 24u}) {
    const std::string text = to_text(wide(), {.columns = columns});
    EXPECT_LE(longest_line(text), columns) << text;
    for (const char* part : {"first", "12", "7", "end", "several"})
      EXPECT_NE(text.find(part), std::string::npos) << part << " is lost\n" << text;
  }
}

TEST(TextLayout, BlocksRepeatTheFirstColumn) {
  const std::string text = to_text(wide(), {.columns = 24});
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find("first", at)) != std::string::npos; ++at) ++count;
  EXPECT_GE(count, 3u) << text;
}

TEST(TextLayout, DetailsAndColumnsWithoutValuesAreLeftOut) {
  const std::string text = to_text(wide(), {.details = false});
  EXPECT_EQ(text.find("detail"), std::string::npos) << text;
  EXPECT_EQ(text.find("empty"), std::string::npos) << text;
  EXPECT_NE(text.find("number of things"), std::string::npos) << text;
}

TEST(TextLayout, RowsBeyondTheScreenAreCounted) {
  Table table{{{"n", "n", true}}, {}};
  for (std::uint64_t i = 0; i < 20; ++i) table.rows.push_back({i});
  const std::string text = to_text(table, {.rows = 5});
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2 + 5 + 1) << text;
  EXPECT_NE(text.find("... 15 more rows"), std::string::npos) << text;
}

TEST(TextLayout, APaintedCellIsAsWideAsItsText) {
  const Table table{{{"a", "a"}, {"b", "b"}}, {{std::string("x"), std::string("y")}}};
  const std::string text =
      to_text(table, {.paint = [](const Column&, const std::string& t) { return "<" + t + ">"; }});
  EXPECT_NE(text.find("<x>  <y>"), std::string::npos) << text;
}

}  // namespace
}  // namespace hwsim::lab
