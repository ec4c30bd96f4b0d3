// What every source keeps to, so that a reader finds a way: an opening sentence, a size that fits a head.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <regex>

#include "rules/documents.h"
#include "support/places.h"

namespace {

using hwsim::test::lines_of;
using hwsim::test::project_files;
using hwsim::test::TextLine;
namespace fs = std::filesystem;

constexpr std::size_t kLinesMax = 450;

/// The comment that a header opens with, as one text.
std::string opening(const fs::path& header) {
  std::string comment;
  for (const TextLine& line : lines_of(header)) {
    if (line.text.empty() || line.text == "#pragma once") continue;
    if (line.text.rfind("//", 0) != 0) break;
    comment += line.text.substr(2);
  }
  return comment;
}

TEST(Sources, EveryHeaderOpensByASentenceThatSaysWhatItIs) {
  const std::regex sentence(R"rx( [A-Za-z0-9$`].*[.:].*)rx");
  std::size_t seen = 0;
  for (const fs::path& file : project_files({".h"})) {
    ++seen;
    EXPECT_TRUE(std::regex_match(opening(file), sentence))
        << file << " opens with \"" << opening(file) << '"';
  }
  EXPECT_GT(seen, 200u) << "the headers were not found";
}

TEST(Sources, NoFileIsLongerThanAReaderCanHold) {
  for (const fs::path& file : project_files({".h", ".cpp", ".py", ".sh", ".cmake"}))
    EXPECT_LE(lines_of(file).size(), kLinesMax) << file;
}

bool is_comment(const std::string& line) {
  const std::size_t at = line.find_first_not_of(' ');
  return at != std::string::npos && line.compare(at, 2, "//") == 0;
}

/// Whether a comment in the line begins with "of".
bool lacks_subject(const std::string& line) {
  for (std::size_t at = line.find("//"); at != std::string::npos; at = line.find("//", at + 1)) {
    const std::size_t word = line.find_first_not_of("/< ", at);
    if (word != std::string::npos && (line.compare(word, 3, "of ") == 0 || line.compare(word, 3, "Of ") == 0))
      return true;
  }
  return false;
}

// A comment that begins with "of" leaves out what it is about.
TEST(Sources, CommentsNameTheirSubject) {
  for (const fs::path& file : project_files({".h", ".cpp"})) {
    bool continues = false;
    for (const TextLine& line : lines_of(file)) {
      const bool begins = !(continues && is_comment(line.text));
      EXPECT_FALSE(begins && lacks_subject(line.text)) << line.place() << ": " << line.text;
      continues = is_comment(line.text);
    }
  }
}

// A time is the machine's: benchmarks state it, as a ratio. What it is caused by can be asserted.
TEST(Sources, NoTestLooksAtAClock) {
  for (const fs::path& file : project_files({".h", ".cpp"})) {
    const std::string path = file.generic_string();
    if (path.rfind("tests/", 0) != 0 || path.rfind("tests/oracle/llvmpipe", 0) == 0 ||  // benchmarks use it
        path == "tests/rules/sources_test.cpp")
      continue;
    for (const TextLine& line : lines_of(file))
      EXPECT_EQ(line.text.find("y_clock::now"), std::string::npos) << line.place() << ": " << line.text;
  }
}

// A newcomer finds the room for any line by reading what each folder says of itself.
TEST(Sources, EveryFolderOfSourcesSaysWhatItIs) {
  constexpr std::size_t kScreen = 70;
  std::set<fs::path> folders;
  for (const fs::path& file : project_files({".h", ".cpp"})) {
    const fs::path folder = file.parent_path();
    const bool is_part_of_tests = folder.generic_string().rfind("tests/", 0) == 0 &&
                                  folder.has_parent_path() && folder.parent_path() != "tests";
    if (!is_part_of_tests) folders.insert(folder);
  }
  EXPECT_GT(folders.size(), 60u) << "the folders were not found";
  for (const fs::path& folder : folders) {
    const fs::path readme = folder / "README.md";
    ASSERT_TRUE(fs::exists(fs::path(hwsim::test::source_dir()) / readme)) << readme;
    EXPECT_LE(lines_of(readme).size(), kScreen) << readme;
  }
}

// Two labs in one process, or a lab in a server, must not change by what some shell exported.
TEST(Sources, NothingInALabReadsTheEnvironment) {
  std::set<std::string> readers;
  for (const fs::path& file : project_files({".h", ".cpp"}))
    for (const TextLine& line : lines_of(file))
      if (line.text.find("getenv(") != std::string::npos && file.generic_string().rfind("lab/", 0) == 0)
        readers.insert(file.generic_string());
  EXPECT_EQ(readers, std::set<std::string>{"lab/environment.cpp"}) << "which only programs call";
}

std::set<std::string> declared_tests() {
  std::set<std::string> tests;
  const std::regex declared(R"rx(TEST(?:_P|_F)?\((\w+), *(\w+).*)rx");
  for (const fs::path& file : project_files({".cpp"}))
    for (const TextLine& line : lines_of(file)) {
      std::smatch match;
      if (line.text.rfind("TEST", 0) == 0 && std::regex_match(line.text, match, declared))
        tests.insert(match[1].str() + "." + match[2].str());
    }
  return tests;
}

/// The texts between backticks.
std::vector<std::string> code_of(const std::string& line) {
  std::vector<std::string> found;
  for (std::size_t open = line.find('`'); open != std::string::npos; open = line.find('`', open + 1)) {
    const std::size_t close = line.find('`', open + 1);
    if (close == std::string::npos) break;
    found.push_back(line.substr(open + 1, close - open - 1));
    open = close;
  }
  return found;
}

bool is_letter_or_digit(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }
bool is_capital(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }

/// Whether a text is a sentence without spaces: three capitals or more, the first in front.
bool is_sentence_name(const std::string& text) {
  return !text.empty() && is_capital(text.front()) && std::ranges::all_of(text, is_letter_or_digit) &&
         std::ranges::count_if(text, is_capital) >= 3;
}

/// The tests that a line of a page names: `Suite.Name`, `Suite.*`, and names behind one of these, whose suite
/// is the last one named.
std::vector<std::string> named_tests(const std::string& line) {
  static const std::regex whole(R"rx(([A-Z]\w*)\.([A-Z]\w*\*?|\*))rx");
  std::vector<std::string> names;
  std::string suite;
  for (const std::string& text : code_of(line)) {
    std::smatch match;
    if (std::regex_match(text, match, whole)) {
      suite = match[1];
      names.push_back(text);
    } else if (!suite.empty() && is_sentence_name(text)) {
      names.push_back(suite + "." + text);
    }
  }
  return names;
}

TEST(Sources, EveryTestThatAPageNamesExists) {
  const std::set<std::string> tests = declared_tests();
  const auto exists = [&](const std::string& name) {
    if (name.back() != '*') return tests.contains(name);
    const std::string start = name.substr(0, name.size() - 1);
    const auto at = tests.lower_bound(start);
    return at != tests.end() && at->rfind(start, 0) == 0;
  };
  std::size_t seen = 0;
  for (const fs::path& page : project_files({".md"}))
    for (const TextLine& line : lines_of(page))
      for (const std::string& name : named_tests(line.text)) {
        ++seen;
        EXPECT_TRUE(exists(name)) << line.place() << ": no test " << name;
      }
  EXPECT_GT(seen, 20u) << "no page names a test";
}

}  // namespace
