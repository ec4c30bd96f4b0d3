// The digests in the keys of the cache cover all that made what is kept: with a source, the headers that it
// includes and the sources beside them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

#include "support/places.h"

namespace {

namespace fs = std::filesystem;

std::set<std::string> digested(const std::string& name) {
  std::ifstream in(hwsim::test::binary_dir() + "/source_digests/" + name + ".txt");
  std::set<std::string> files;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) files.insert(line);
  return files;
}

bool exists(const std::string& file) { return fs::exists(fs::path(hwsim::test::source_dir()) / file); }

/// The project's files that one includes, and the sources of these.
std::set<std::string> needed_by(const std::string& file) {
  static const std::regex include(R"rx(^#include "([^"]+)")rx");
  std::ifstream in(fs::path(hwsim::test::source_dir()) / file);
  std::set<std::string> needed;
  std::smatch match;
  for (std::string line; std::getline(in, line);) {
    if (!std::regex_search(line, match, include)) continue;
    const std::string header = match[1], source = header.substr(0, header.rfind('.')) + ".cpp";
    for (const std::string& part : {header, source})
      if (exists(part)) needed.insert(part);
  }
  return needed;
}

TEST(Digests, CoverWhatTheirSourcesInclude) {
  for (const std::string name : {"generators", "emulation", "reference"}) {
    const std::set<std::string> files = digested(name);
    EXPECT_GT(files.size(), 20u) << name;
    for (const std::string& file : files)
      for (const std::string& needed : needed_by(file))
        EXPECT_TRUE(files.contains(needed)) << name << ": " << file << " includes " << needed;
  }
}

TEST(Digests, DoNotChangeWithWhatDecidesNothing) {
  const std::set<std::string> emulation = digested("emulation");
  for (const std::string& file : emulation) {
    EXPECT_NE(file.rfind("hwsim/engines/", 0), 0u) << file << " decides times, not work";
    EXPECT_NE(file.rfind("pipeline/reference/", 0), 0u) << file << " decides references, not work";
  }
}

}  // namespace
