// What is installed can be compiled: cmake/public_headers.txt names existing headers and leaves none out that
// one of them includes.
#include <gtest/gtest.h>

#include "rules/folders.h"

namespace {

using hwsim::test::Include;
using hwsim::test::lines_of;
using hwsim::test::project_files;
using hwsim::test::project_includes;
using hwsim::test::TextLine;
namespace fs = std::filesystem;

/// The lines that name headers and folders.
std::vector<TextLine> listed() {
  std::vector<TextLine> lines;
  for (const TextLine& line : lines_of("cmake/public_headers.txt"))
    if (!line.text.empty() && line.text.front() != '#') lines.push_back(line);
  return lines;
}

std::set<std::string> public_headers() {
  std::set<std::string> headers;
  for (const fs::path& file : project_files({".h"})) {
    const std::string name = file.generic_string();
    for (const TextLine& line : listed()) {
      const bool below = line.text.back() == '/' && name.rfind(line.text, 0) == 0 &&
                         name.find("-inl.h") == std::string::npos;
      if (below || name == line.text) headers.insert(name);
    }
  }
  return headers;
}

TEST(PublicHeaders, EveryListedOneExists) {
  const std::set<std::string> headers = public_headers();
  EXPECT_GT(headers.size(), 50u);
  for (const TextLine& line : listed()) {
    const auto at = headers.lower_bound(line.text);
    EXPECT_TRUE(at != headers.end() && at->rfind(line.text, 0) == 0) << line.place() << ": no " << line.text;
  }
}

TEST(PublicHeaders, IncludePublicHeadersAlone) {
  const std::set<std::string> headers = public_headers();
  for (const Include& include : project_includes()) {
    if (!headers.contains(include.line.file.generic_string())) continue;
    EXPECT_TRUE(headers.contains(include.to)) << include.line.place() << ": list " << include.to
                                              << " in cmake/public_headers.txt, or do not include it";
  }
}

}  // namespace
