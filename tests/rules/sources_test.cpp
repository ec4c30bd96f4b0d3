// What every source keeps to, so that a reader finds a way: an opening sentence, a size that fits a head.
#include <gtest/gtest.h>

#include <regex>

#include "rules/documents.h"

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

/// Folders that still have headers without an opening, and comments without a subject.
const std::set<std::string> kNotYet = {"algos", "cli", "cost_models", "hwsim", "lab"};
bool is_due(const fs::path& file) { return !kNotYet.contains(file.begin()->string()); }

TEST(Sources, EveryHeaderOpensByASentenceThatSaysWhatItIs) {
  const std::regex sentence(R"rx( [A-Z0-9`].*[.:].*)rx");
  std::size_t seen = 0;
  for (const fs::path& file : project_files({".h"})) {
    ++seen;
    if (!is_due(file)) continue;
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

// A comment that begins with "of" leaves out what it is about.
TEST(Sources, CommentsNameTheirSubject) {
  const std::regex no_subject(R"rx(.*//+<? *[Oo]f .*)rx");
  for (const fs::path& file : project_files({".h", ".cpp"})) {
    if (!is_due(file)) continue;
    bool continues = false;
    for (const TextLine& line : lines_of(file)) {
      const bool begins = !(continues && is_comment(line.text));
      EXPECT_FALSE(begins && std::regex_match(line.text, no_subject)) << line.place() << ": " << line.text;
      continues = is_comment(line.text);
    }
  }
}

std::set<std::string> declared_tests() {
  std::set<std::string> tests;
  const std::regex declared(R"rx(^TEST(?:_P|_F)?\((\w+), *(\w+).*)rx");
  for (const fs::path& file : project_files({".cpp"}))
    for (const TextLine& line : lines_of(file)) {
      std::smatch match;
      if (line.text.rfind("TEST", 0) == 0 && std::regex_match(line.text, match, declared))
        tests.insert(match[1].str() + "." + match[2].str());
    }
  return tests;
}

/// The tests that a line of a page names: `Suite.Name`, `Suite.*`, and names behind one of these, whose suite
/// is the last one named.
std::vector<std::string> named_tests(const std::string& line) {
  const std::regex whole(R"rx(([A-Z]\w*)\.([A-Z]\w*\*?|\*))rx"), name(R"rx(([A-Z][a-z0-9]*){3,})rx");
  const std::regex code(R"rx(`([^`]+)`)rx");
  std::vector<std::string> names;
  std::string suite;
  for (std::sregex_iterator i(line.begin(), line.end(), code), end; i != end; ++i) {
    const std::string text = (*i)[1];
    std::smatch match;
    if (std::regex_match(text, match, whole)) {
      suite = match[1];
      names.push_back(text);
    } else if (!suite.empty() && std::regex_match(text, name)) {
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
