// What documents, sources, configuration and messages refer to exists in this repository.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "rules/documents.h"

namespace {

using hwsim::test::anchors_of;
using hwsim::test::broken_link;
using hwsim::test::lines_of;
using hwsim::test::project_files;
using hwsim::test::prose_of;
using hwsim::test::TextLine;
namespace fs = std::filesystem;

const std::vector<std::string> kTexts = {".md",    ".h",  ".cpp", ".toml", ".csv", ".txt",
                                         ".cmake", ".py", ".sh",  ".json", ".yml"};

bool is_this_test(const fs::path& file) { return file.parent_path() == "tests/rules"; }

/// Whether a line can match at all: expressions are slow, and few lines do.
bool has_one_of(const TextLine& line, const std::vector<std::string>& words) {
  return std::ranges::any_of(
      words, [&](const std::string& word) { return line.text.find(word) != std::string::npos; });
}

/// The first groups of all matches in a text.
std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (auto i = std::sregex_iterator(text.begin(), text.end(), pattern); i != std::sregex_iterator(); ++i)
    found.push_back((*i)[1]);
  return found;
}

// A link within a page may leave the page's name out.
std::string with_page(const TextLine& line, const std::string& target) {
  return target.front() == '#' ? line.file.filename().string() + target : target;
}

TEST(DocLinks, EveryLinkOfAPageLeadsToAFileAndASection) {
  const std::regex link(R"rx(\]\(([^)\s]+)\))rx");
  std::size_t seen = 0;
  for (const fs::path& page : project_files({".md"}))
    for (const TextLine& line : prose_of(page))
      for (const std::string& target : matches(line.text, link)) {
        ++seen;
        EXPECT_EQ(broken_link(page.parent_path(), with_page(line, target)), "") << line.place();
      }
  EXPECT_GT(seen, 100u) << "the pages were not found";
}

TEST(DocLinks, EveryDocumentThatASourceNamesExistsWithItsSection) {
  const std::regex named(R"rx((docs/[A-Za-z0-9_/.-]*\.md(#[a-z0-9_-]+)?))rx");
  std::size_t seen = 0;
  for (const fs::path& file : project_files(kTexts)) {
    if (is_this_test(file)) continue;
    for (const TextLine& line : lines_of(file)) {
      if (!has_one_of(line, {"docs/"})) continue;
      for (const std::string& target : matches(line.text, named)) {
        ++seen;
        EXPECT_EQ(broken_link("", target), "") << line.place();
      }
    }
  }
  EXPECT_GT(seen, 100u) << "the sources were not found";
}

// Numbers of sections in documents that are not here: nobody could follow them.
TEST(DocLinks, NothingRefersToDocumentsThatAreNotHere) {
  const std::regex elsewhere(
      R"rx((\b(?:[Tt]echniques|gpus|interfaces|contradictions?)(?:\.md)? (?:sections? )?[0-9]|fact sheet|of the sheet))rx");
  for (const fs::path& file : project_files(kTexts)) {
    if (is_this_test(file)) continue;
    for (const TextLine& line : lines_of(file)) {
      if (!has_one_of(line, {"echniques", "gpus", "interfaces", "ontradiction", "sheet"})) continue;
      EXPECT_TRUE(matches(line.text, elsewhere).empty()) << line.place() << ": " << line.text;
    }
  }
}

TEST(DocLinks, EverySourceOfAGpuFileIsListed) {
  const fs::path table = "configs/sources.csv";
  std::set<std::string> listed;
  for (const TextLine& line : lines_of(table)) listed.insert(line.text.substr(0, line.text.find(',')));
  const std::regex quoted(R"rx(source = "([^"]*)")rx"), bracketed(R"rx(\[([^\],]+))rx");
  std::set<std::string> used;
  for (const fs::path& file : project_files({".toml"}))
    for (const TextLine& line : lines_of(file))
      for (const std::string& source : matches(line.text, quoted))
        for (const std::string& key : matches(source, bracketed)) {
          used.insert(key);
          EXPECT_TRUE(listed.contains(key)) << line.place() << ": [" << key << "] is not in " << table;
        }
  EXPECT_GT(used.size(), 30u) << "the GPU files were not found";
  const std::regex in_page(R"rx((?:^|[^\]\w])\[([A-Z][A-Z0-9]+(?:-[A-Z0-9]+)*)\](?!\())rx");
  for (const fs::path& page : project_files({".md"})) {
    if (*page.begin() != "docs") continue;
    for (const TextLine& line : prose_of(page))
      for (const std::string& key : matches(line.text, in_page))
        EXPECT_TRUE(listed.contains(key)) << line.place() << ": [" << key << "] is not in " << table;
  }
}

TEST(DocLinks, EveryPageOpensBySayingWhatItIsFor) {
  for (const fs::path& page : project_files({".md"})) {
    if (*page.begin() != "docs") continue;
    const auto lines = lines_of(page);
    ASSERT_GT(lines.size(), 2u) << page;
    EXPECT_EQ(lines[0].text.rfind("# ", 0), 0u) << page << " has no title";
    EXPECT_EQ(lines[2].text.rfind("Th", 0), 0u)
        << page << " does not open with \"This page\" or \"These pages\"";
    EXPECT_NE(lines[2].text.find(" page"), std::string::npos) << page;
  }
}

// A command of a page that runs no test would look like one that passes.
TEST(DocLinks, EveryTestSuiteThatAPageNamesExists) {
  std::set<std::string> suites;
  const std::regex declared(R"rx(^TEST(?:_P|_F)?\((\w+))rx");
  for (const fs::path& file : project_files({".cpp"}))
    for (const TextLine& line : lines_of(file)) {
      if (line.text.rfind("TEST", 0) != 0) continue;
      for (const std::string& suite : matches(line.text, declared)) suites.insert(suite);
    }
  const auto exists = [&](const std::string& start) {
    const auto at = suites.lower_bound(start);
    return at != suites.end() && at->rfind(start, 0) == 0;
  };
  for (const fs::path& page : project_files({".md"}))
    for (const TextLine& line : lines_of(page))
      for (const std::string& filter : matches(line.text, std::regex(R"rx(gtest_filter='?([\w.*:/]+))rx")))
        for (const std::string& suite : matches(filter, std::regex(R"rx((?:^|:)(\w+))rx")))
          EXPECT_TRUE(exists(suite)) << line.place() << ": no test suite begins with " << suite;
}

// Sources move; what a page calls `folder/file.h` has to follow.
TEST(DocLinks, EveryFileThatAPageNamesExists) {
  const std::regex path(
      R"rx(`((?:algos|benchmarks|cli|cmake|configs|cost_models|docs|hwsim|lab|page|pipeline|python|scripts|tests)/[\w./-]+))rx");
  for (const fs::path& page : project_files({".md"})) {
    if (page == "CHANGELOG.md") continue;
    for (const TextLine& line : lines_of(page))
      for (const std::string& name : matches(line.text, path)) {
        if (name.find("NAME") != std::string::npos) continue;
        EXPECT_EQ(broken_link("", name), "") << line.place();
      }
  }
}

}  // namespace
