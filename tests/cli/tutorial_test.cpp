// Every command of docs/tutorials, in the order of its page and in one folder. Pictures are small here: what
// they show is asserted elsewhere. HWSIM_TUTORIALS=full runs the commands as they stand.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>

#include "cli/program.h"
#include "support/places.h"

namespace hwsim::cli::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> commands_of(const fs::path& page) {
  std::ifstream file(page);
  std::vector<std::string> commands;
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("    hwsim ")) commands.push_back(line.substr(std::string("    hwsim ").size()));
  return commands;
}

bool is_full() { return std::getenv("HWSIM_TUTORIALS") != nullptr; }

std::string quick(std::string command) {
  if (is_full()) return command;
  command = std::regex_replace(command, std::regex("640x360"), "64x36");
  return std::regex_replace(command, std::regex("--reference [0-9]+"), "--reference 1");
}

/// Published tables of small frames: those of their papers take minutes.
void write_small_tables(const Workplace& place) {
  fs::copy(hwsim::test::source_dir() + "/configs", place / "configs", fs::copy_options::recursive);
  const std::string table = place.read("configs/published/axaa_table1.csv");
  place.write("configs/published/axaa_table1.csv",
              std::regex_replace(table, std::regex("1920x1080"), "64x36"));
}

class TutorialTest : public testing::TestWithParam<const char*> {};

TEST_P(TutorialTest, EveryCommandRuns) {
  const Workplace place;
  place.write("my_scene.gltf", kTriangleGltf);
  if (!is_full()) write_small_tables(place);
  const std::vector<std::string> commands =
      commands_of(hwsim::test::source_dir() + "/docs/tutorials/" + GetParam() + ".md");
  EXPECT_GE(commands.size(), 6u);
  for (const std::string& command : commands) {
    const Outcome outcome = place.hwsim(quick(command), is_full() ? "" : "HWSIM_CONFIG_DIR=configs");
    EXPECT_EQ(outcome.status, 0) << command << "\n" << outcome.err;
    EXPECT_FALSE(outcome.out.empty() && outcome.err.empty()) << command;
  }
}

INSTANTIATE_TEST_SUITE_P(Pages, TutorialTest,
                         testing::Values("rendering_engineer", "gpu_architect", "researcher"),
                         [](const auto& page) { return std::string(page.param); });

// A page that nobody leads to, or that no test runs.
TEST(TutorialPages, AreTheOnesThatAreTested) {
  for (const fs::directory_entry& entry :
       fs::directory_iterator(hwsim::test::source_dir() + "/docs/tutorials")) {
    const std::string name = entry.path().stem().string();
    EXPECT_TRUE(name == "README" || name == "rendering_engineer" || name == "gpu_architect" ||
                name == "researcher")
        << name;
  }
}

}  // namespace
}  // namespace hwsim::cli::test
