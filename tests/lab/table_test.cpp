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

}  // namespace
}  // namespace hwsim::lab
