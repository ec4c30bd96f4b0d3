// Includes point one way: between libraries, between the folders of each, and as docs/floors.md draws them.
#include <gtest/gtest.h>

#include <regex>

#include "rules/folders.h"

namespace {

using hwsim::test::arrows_between_children;
using hwsim::test::circular;
using hwsim::test::folders_with_sources;
using hwsim::test::Include;
using hwsim::test::kSourceFolders;
using hwsim::test::lines_of;
using hwsim::test::project_files;
using hwsim::test::project_includes;
using hwsim::test::TextLine;

const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"hwsim", {}},
    {"pipeline", {"hwsim"}},
    {"algos", {"hwsim", "pipeline"}},
    {"cost_models", {"hwsim"}},
    {"lab", {"hwsim", "pipeline", "algos", "cost_models"}},
    {"cli", {"hwsim", "pipeline", "algos", "cost_models", "lab"}},
    {"page", {"hwsim"}},
    {"python", {"hwsim", "pipeline", "algos", "cost_models", "lab"}},
    {"benchmarks", {"hwsim", "pipeline", "algos", "cost_models", "lab"}}};

std::string top_of(const std::string& folder) { return folder.substr(0, folder.find('/')); }

TEST(IncludeRule, IncludesPointOneWay) {
  size_t seen = 0;
  for (const Include& include : project_includes()) {
    const std::string from = top_of(include.from_folder()), to = top_of(include.to_folder());
    ++seen;
    EXPECT_TRUE(from == to || kMayInclude.at(from).contains(to))
        << include.line.place() << ": " << include.line.text;
  }
  EXPECT_GT(seen, 1000u) << "the sources were not found";
}

// A folder stands for all that lies below it: two rooms may not lean on each other by their sub-folders
// either.
TEST(IncludeRule, FoldersFormNoCircle) {
  std::set<std::string> parents;
  for (const std::string& top : kSourceFolders)
    for (std::string at : folders_with_sources(top)) {
      parents.insert(at);
      for (; at.find('/') != std::string::npos; parents.insert(at)) at = at.substr(0, at.rfind('/'));
    }
  EXPECT_GT(parents.size(), 30u) << "the folders were not found";
  const std::vector<Include> includes = project_includes();
  for (const std::string& parent : parents)
    for (const Include& include : circular(arrows_between_children(parent, includes)))
      ADD_FAILURE() << include.line.place() << ": " << include.to << " is on a floor that includes this one";
}

/// The rooms of a library as docs/floors.md draws them: the number of each one's row, from the top.
std::map<std::string, int> drawn_rooms(const std::string& library) {
  std::map<std::string, int> rooms;
  const std::regex name(R"rx(`([\w/]+)`)rx");
  bool inside = false;
  for (const TextLine& line : lines_of("docs/floors.md")) {
    if (line.text.rfind("## ", 0) == 0) inside = line.text == "## " + library;
    if (!inside || line.text.rfind("| `", 0) != 0) continue;
    const std::string cell = line.text.substr(0, line.text.find('|', 1));
    for (std::sregex_iterator i(cell.begin(), cell.end(), name), end; i != end; ++i)
      EXPECT_TRUE(rooms.emplace((*i)[1], line.number).second) << line.place() << ": " << (*i)[1] << " twice";
  }
  return rooms;
}

std::vector<std::string> drawn_libraries() {
  std::vector<std::string> libraries;
  for (const TextLine& line : lines_of("docs/floors.md"))
    for (const std::string& library : kSourceFolders)
      if (line.text == "## " + library) libraries.push_back(library);
  return libraries;
}

TEST(IncludeRule, EveryRoomIsDrawnAndNothingElse) {
  EXPECT_GE(drawn_libraries().size(), 1u) << "docs/floors.md draws nothing";
  for (const std::string& library : drawn_libraries()) {
    const std::map<std::string, int> drawn = drawn_rooms(library);
    const std::set<std::string> folders = folders_with_sources(library);
    for (const std::string& folder : folders)
      EXPECT_TRUE(drawn.contains(folder)) << "draw " << folder << " in docs/floors.md";
    for (const auto& [room, row] : drawn)
      EXPECT_TRUE(folders.contains(room)) << "docs/floors.md:" << row << ": no sources in " << room;
  }
}

TEST(IncludeRule, IncludesPointDownInTheDrawnFloors) {
  const std::vector<Include> includes = project_includes();
  for (const std::string& library : drawn_libraries()) {
    const std::map<std::string, int> drawn = drawn_rooms(library);
    for (const Include& include : includes) {
      const std::string from = include.from_folder(), to = include.to_folder();
      if (from == to || !drawn.contains(from) || !drawn.contains(to)) continue;
      EXPECT_LT(drawn.at(from), drawn.at(to))
          << include.line.place() << ": docs/floors.md draws " << to << " not below " << from;
    }
  }
}

/// The row of each library's name in the drawing of docs/architecture.md.
std::map<std::string, int> drawn_libraries_of_architecture() {
  std::map<std::string, int> rows;
  bool inside = false;
  for (const TextLine& line : lines_of("docs/architecture.md")) {
    if (line.text.find("floors:begin") != std::string::npos) inside = true;
    if (line.text.find("floors:end") != std::string::npos) inside = false;
    if (!inside) continue;
    for (const std::string& library : kSourceFolders)
      if (std::regex_search(line.text.substr(0, 44), std::regex("\\b" + library + "\\b")))
        rows.emplace(library, line.number);
  }
  return rows;
}

TEST(IncludeRule, ArchitectureDrawsEveryLibraryAboveWhatItIncludes) {
  const std::map<std::string, int> rows = drawn_libraries_of_architecture();
  for (const std::string& library : kSourceFolders)
    ASSERT_TRUE(rows.contains(library)) << library << " is not drawn in docs/architecture.md";
  for (const Include& include : project_includes()) {
    const std::string from = top_of(include.from_folder()), to = top_of(include.to_folder());
    if (from == to) continue;
    EXPECT_LT(rows.at(from), rows.at(to)) << from << " includes " << to;
  }
}

// Every include of the project's own files is written from the root, or the rules above could not see it.
TEST(IncludeRule, IncludesAreWrittenFromTheRoot) {
  const std::regex relative(R"rx(\s*#\s*include\s+"(\.|[^"/]+").*)rx");
  for (const std::filesystem::path& file : project_files({".h", ".cpp"})) {
    const std::string top = file.begin()->string();
    if (!kMayInclude.contains(top) || top == "benchmarks") continue;
    for (const TextLine& line : lines_of(file))
      EXPECT_FALSE(std::regex_match(line.text, relative)) << line.place() << ": " << line.text;
  }
}

// Predictions may not know the published times that they are compared with.
TEST(IncludeRule, SimulatorDoesNotNamePublishedTables) {
  const std::set<std::string> simulator = {"hwsim", "pipeline", "algos"};
  for (const std::filesystem::path& file : project_files({".h", ".cpp"})) {
    if (!simulator.contains(file.begin()->string())) continue;
    for (const TextLine& line : lines_of(file))
      EXPECT_EQ(line.text.find("configs/published"), std::string::npos) << line.place() << ": " << line.text;
  }
}

// The search for circles finds one over three folders, and leaves a ladder alone.
TEST(IncludeRule, CirclesAreFoundOverSeveralFolders) {
  const auto include = [](const std::string& from, const std::string& to) {
    return Include{{from + "/a.h", 1, ""}, to + "/b.h"};
  };
  const std::vector<Include> ladder = {include("x/a", "x/b"), include("x/b", "x/c"), include("x/a", "x/c")};
  EXPECT_TRUE(circular(arrows_between_children("x", ladder)).empty());
  std::vector<Include> circle = ladder;
  circle.push_back(include("x/c/deep", "x/a"));
  EXPECT_EQ(circular(arrows_between_children("x", circle)).size(), 4u);
}

}  // namespace
