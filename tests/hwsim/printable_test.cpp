#include "hwsim/base/printable.h"

#include <gtest/gtest.h>

#include "hwsim/base/diagnostics.h"

namespace hwsim {
namespace {

TEST(Printable, KeepsWhatAReaderSees) {
  for (const char* text : {"", "plain text, with ~ and {}", "a\tb\nc", "line\r\n", "Gr\xc3\xbc\xc3\x9f",
                           "\xe2\x82\xac 5", "\xf0\x9f\x98\x80"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesWhatATerminalObeys) {
  EXPECT_EQ(printable("\x1b]0;title\x07"), "\\x1b]0;title\\x07");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
  EXPECT_EQ(printable("a\rb"), "a\\x0db") << "it would write over the beginning of the line";
  EXPECT_EQ(printable("\x7f"), "\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\x9b31m")
      << "a control sequence of one character";
  EXPECT_EQ(printable("\xe2\x80\xae"
                      "fdp.exe"),
            "\\u202efdp.exe");
  EXPECT_EQ(printable_line("a\tb\nerror: c"), "a\\x09b\\x0aerror: c");
}

TEST(Printable, EscapesWhatIsNoUtf8) {
  EXPECT_EQ(printable("\xff"), "\\xff");
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf") << "a slash written too long";
  EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82") << "it ends within a character";
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "half of a pair";
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond the last character";
}

TEST(Printable, MessagesAreMadeOfIt) {
  Diagnostic d{.code = "S004", .message = "name \x1b[2J"};
  d.place = {.file = "a\nb.gltf", .line = 3, .column = 2, .line_text = "x\x1b[1my"};
  d.notes = {"\x9c"};
  d.help = "\x07";
  const std::string text = render(d, false);
  for (const char c : {'\x1b', '\x07', '\x9c'}) EXPECT_EQ(text.find(c), std::string::npos) << text;
  EXPECT_NE(text.find("a\\x0ab.gltf:3:2"), std::string::npos) << text;
}

}  // namespace
}  // namespace hwsim
