// design: includes point one way, hwsim <- pipeline <- algos and hwsim <- cost_models; cli sees all.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "support/places.h"

namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::vector<std::string>> kMayInclude = {
    {"hwsim", {"hwsim"}},
    {"pipeline", {"hwsim", "pipeline"}},
    {"algos", {"hwsim", "pipeline", "algos"}},
    {"cost_models", {"hwsim", "cost_models"}},
    {"cli", {"hwsim", "pipeline", "algos", "cost_models", "cli"}}};

std::vector<fs::path> sources_of(const std::string& folder) {
  std::vector<fs::path> files;
  const fs::path root = fs::path(hwsim::test::source_dir()) / folder;
  if (!fs::exists(root)) return files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root))
    if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp") files.push_back(entry.path());
  return files;
}

std::vector<std::string> lines_of(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

bool allowed(const std::vector<std::string>& folders, const std::string& folder) {
  return std::find(folders.begin(), folders.end(), folder) != folders.end();
}

TEST(IncludeRule, IncludesPointOneWay) {
  const std::regex include(R"rx(\s*#\s*include\s+"([a-z_]+)/[^"]+".*)rx");
  size_t seen = 0;
  for (const auto& [folder, may_include] : kMayInclude)
    for (const fs::path& path : sources_of(folder)) {
      const std::vector<std::string> lines = lines_of(path);
      for (size_t i = 0; i < lines.size(); ++i) {
        std::smatch match;
        if (!std::regex_match(lines[i], match, include) || !kMayInclude.contains(match[1])) continue;
        ++seen;
        EXPECT_TRUE(allowed(may_include, match[1])) << path.string() << ":" << i + 1 << ": " << lines[i];
      }
    }
  EXPECT_GT(seen, 100u) << "the sources were not found";
}

// Every include of the project's own files is written from the root, or the rule above could not see it.
TEST(IncludeRule, IncludesAreWrittenFromTheRoot) {
  const std::regex relative(R"rx(\s*#\s*include\s+"(\.|[^"/]+").*)rx");
  for (const auto& [folder, may_include] : kMayInclude)
    for (const fs::path& path : sources_of(folder))
      for (const std::string& line : lines_of(path))
        EXPECT_FALSE(std::regex_match(line, relative)) << path.string() << ": " << line;
}

// Predictions may not know the published times that they are compared with.
TEST(IncludeRule, SimulatorDoesNotNamePublishedTables) {
  for (const char* folder : {"hwsim", "pipeline", "algos"})
    for (const fs::path& path : sources_of(folder))
      for (const std::string& line : lines_of(path))
        EXPECT_EQ(line.find("configs/published"), std::string::npos) << path.string() << ": " << line;
}

}  // namespace
