#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "cli/program.h"
#include "support/places.h"

namespace hwsim::cli::test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kCommands = {
    "",          "run",    "explain",      "rank",        "compare",     "sweep",         "reference",
    "optimize",  "report", "list",         "show",        "scene",       "scene check",   "gpu",
    "gpu new",   "config", "config check", "config show", "config diff", "config schema", "doctor",
    "help",      "cache",  "cache list",   "cache prune", "fit",         "validate",      "reproduce",
    "completion"};

std::vector<std::string> examples_of(const std::string& help) {
  std::vector<std::string> examples;
  std::istringstream lines(help);
  std::string line;
  std::getline(lines, line);
  if (line != "Examples:") return {};
  while (std::getline(lines, line) && line.rfind("  hwsim ", 0) == 0) examples.push_back(line);
  return examples;
}

class Help : public testing::TestWithParam<std::string> {};

TEST_P(Help, OpensWithExamplesThatRun) {
  const Workplace place;
  const Outcome help = place.hwsim(GetParam() + " --help");
  ASSERT_EQ(help.status, 0) << help.err;
  const std::vector<std::string> examples = examples_of(help.out);
  EXPECT_GE(examples.size(), 2u) << help.out;
  EXPECT_LE(examples.size(), 3u);
  for (const std::string& example : examples) {
    const Outcome outcome = place.shell(example);
    EXPECT_EQ(outcome.status, 0) << example << "\n" << outcome.err;
  }
}

INSTANTIATE_TEST_SUITE_P(, Help, testing::ValuesIn(kCommands), [](const auto& info) {
  return info.param.empty() ? std::string("top") : std::regex_replace(info.param, std::regex(" "), "_");
});

TEST(HelpTest, EveryCommandOfTheTopLevelIsTested) {
  const Workplace place;
  const std::string help = place.hwsim("--help").out;
  std::istringstream lines(help.substr(help.find("Subcommands:")));
  std::string line;
  std::getline(lines, line);
  size_t count = 0;
  while (std::getline(lines, line) && !line.empty()) {
    const std::string name = line.substr(2, line.find(' ', 2) - 2);
    EXPECT_NE(std::find(kCommands.begin(), kCommands.end(), name), kCommands.end()) << name;
    ++count;
  }
  EXPECT_GE(count, 10u);
}

TEST(HelpTest, ListsCommandsAndCodes) {
  const Workplace place;
  const std::string text = place.hwsim("help").out;
  for (const char* word : {"\nsweep ", "\ncache prune ", "\nC012 "})
    EXPECT_NE(text.find(word), std::string::npos) << word << " is not in:\n" << text;
}

TEST(HelpTest, SaysWhatHappens) {
  const Workplace place;
  EXPECT_NE(place.hwsim("rank --help").out.find("default all"), std::string::npos);
  const std::string run = place.hwsim("run --help").out;
  EXPECT_NE(run.find("default none"), std::string::npos);
  EXPECT_NE(run.find("elsewhere a line for every"), std::string::npos) << run;
}

// A code that nobody explains sends the user to a dead end; an explanation of a code that is gone misleads.
TEST(HelpTest, ExplainsExactlyTheCodesThatTheSourcesUse) {
  const std::regex code("\"([A-Z][0-9]{3})\"");
  std::set<std::string> used;
  for (const char* folder : {"hwsim", "pipeline", "algos", "cost_models", "lab", "cli"}) {
    if (!fs::exists(fs::path(hwsim::test::source_dir()) / folder)) continue;
    for (const fs::directory_entry& entry :
         fs::recursive_directory_iterator(fs::path(hwsim::test::source_dir()) / folder)) {
      const std::string ending = entry.path().extension().string();
      if ((ending != ".cpp" && ending != ".h") || entry.path().filename() == "error_codes.cpp" ||
          entry.path().filename() == "remedies.cpp")
        continue;
      std::ifstream file(entry.path());
      std::ostringstream buffer;
      buffer << file.rdbuf();
      const std::string text = buffer.str();
      for (std::sregex_iterator at(text.begin(), text.end(), code), end; at != end; ++at)
        used.insert((*at)[1]);
    }
  }
  const Workplace place;
  std::set<std::string> explained;
  for (const auto& row : nlohmann::json::parse(place.hwsim("help --json").out)) explained.insert(row["code"]);
  for (const std::string& each : used) EXPECT_TRUE(explained.contains(each)) << each << " is not explained";
  for (const std::string& each : explained) EXPECT_TRUE(used.contains(each)) << each << " is used nowhere";
  for (const std::string& each : {std::string("C012"), std::string("u001")})
    EXPECT_EQ(place.hwsim("help " + each).status, 0) << each;
}

TEST(CompletionTest, ScriptsAreValidInTheirShells) {
  const Workplace place;
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    const Outcome script = place.hwsim("completion " + shell);
    ASSERT_EQ(script.status, 0);
    place.write("script." + shell, script.out);
    if (place.shell("command -v " + shell).status != 0) continue;
    const Outcome outcome = place.shell(shell + " -n script." + shell);
    EXPECT_EQ(outcome.status, 0) << shell << ": " << outcome.err;
  }
}

/// What bash offers for the word `index` of a command line.
class BashCompletion {
 public:
  explicit BashCompletion(const Workplace& place) : place_(place) {
    place.write("complete.bash", place.hwsim("completion bash").out);
  }
  std::string operator()(const std::string& words, int index) const {
    return place_
        .shell("bash -c 'source ./complete.bash; COMP_WORDS=(" + words +
               "); COMP_CWORD=" + std::to_string(index) + "; _hwsim; echo \"${COMPREPLY[@]}\"'")
        .out;
  }

 private:
  const Workplace& place_;
};

TEST(CompletionTest, BashCompletesCommandsFlagsAndValues) {
  const Workplace place;
  const BashCompletion complete(place);
  EXPECT_EQ(complete("hwsim refer", 1), "reference\n");
  EXPECT_NE(complete("hwsim run --tech", 2).find("--technique"), std::string::npos);
  EXPECT_NE(complete("hwsim run --gpu gtx98", 3).find("gtx980"), std::string::npos);
  EXPECT_NE(complete("hwsim config ch", 2).find("check"), std::string::npos);
  EXPECT_NE(complete("hwsim reproduce SB", 2).find("SBAA"), std::string::npos);
  EXPECT_NE(complete("hwsim help C01", 2).find("C012"), std::string::npos);
}

TEST(CompletionTest, BashCompletesListsAndSettings) {
  const Workplace place;
  const BashCompletion complete(place);
  EXPECT_EQ(complete("hwsim run -g gtx980,hd58", 3), "gtx980,hd5870\n");
  EXPECT_NE(complete("hwsim run -t none,msaa", 3).find("none,msaa4x"), std::string::npos);
  EXPECT_NE(complete("hwsim compare --what-if dram-x2,rops", 3).find("dram-x2,rops-x2"), std::string::npos);
  EXPECT_EQ(complete("hwsim run --set gpu.core_cl", 3), "gpu.core_clock_mhz=\n");
  EXPECT_EQ(complete("hwsim run --set scene.shadow_m", 3), "scene.shadow_map_px=\n");
  EXPECT_EQ(complete("hwsim sweep --vary gpu.l2_si", 3), "gpu.l2_size_kib=\n");
}

}  // namespace
}  // namespace hwsim::cli::test
