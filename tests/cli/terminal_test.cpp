// What people see on a terminal of 80 columns and 24 lines, which `script` plays.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <sstream>

#include "cli/program.h"

namespace hwsim::cli::test {
namespace {

constexpr std::size_t kColumns = 80, kLines = 24;

class TerminalTest : public testing::Test {
 protected:
  TerminalTest() { place.write("triangle.gltf", kTriangleGltf); }

  /// Standard output of a command on a terminal.
  std::string shown(const std::string& words, const std::string& environment = "TERM=xterm") const {
    const Outcome outcome = place.shell(environment + " script -qec 'stty cols 80 rows 24; hwsim " + words +
                                        " 2>errors' /dev/null </dev/null");
    std::string text = outcome.out;
    std::erase(text, '\r');
    return text;
  }

  Workplace place;
};

std::string without_colors(const std::string& text) {
  return std::regex_replace(text, std::regex("\x1b\\[[0-9;]*m"), "");
}

std::size_t columns_of(const std::string& line) {
  return static_cast<std::size_t>(
      std::ranges::count_if(line, [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(without_colors(text));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

constexpr const char* kView = "triangle.gltf --resolution 64x48 --force ";

TEST_F(TerminalTest, EveryAnswerIsAsWideAsTheTerminal) {
  for (const std::string& words :
       {std::string("list gpus"), std::string("list techniques"), std::string("list counters"),
        std::string("list overlays"), std::string("list settings"), std::string("show gtx980 --origin"),
        std::string("show sbaa_top"), std::string("cache list"), std::string("validate --external"),
        std::string("config diff gtx980 gtx970"),
        "run " + std::string(kView) + "-v --out a -t deferred_simple_complex --reference 2",
        "run " + std::string(kView) + "--out b -t none,msaa4x,deferred_simple_complex -g gtx980,rtx4090",
        "compare " + std::string(kView) + "-v -t none,msaa4x --what-if dram-x2,rops-x2,l2-x4",
        "explain " + std::string(kView) + "-v -t deferred_simple_complex",
        "rank " + std::string(kView) + "-v --out c -t msaa4x,none+fxaa --reference 2"}) {
    const std::vector<std::string> lines = lines_of(shown(words));
    EXPECT_GT(lines.size(), 2u) << words;
    for (const std::string& line : lines) EXPECT_LE(columns_of(line), kColumns) << words << "\n" << line;
  }
}

TEST_F(TerminalTest, AnAnswerFitsOnOneScreen) {
  for (const std::string& words :
       {"run " + std::string(kView) + "--out a -t deferred_simple_complex --reference 2",
        "run " + std::string(kView) + "--out b -t none,msaa4x,deferred_simple_complex",
        "compare " + std::string(kView) + "-t none,msaa4x,msaa8x --what-if dram-x2,l2-x4",
        "rank " + std::string(kView) + "--out c -t msaa4x,none+fxaa --reference 2"}) {
    const std::string text = shown(words);
    EXPECT_LE(lines_of(text).size(), kLines) << words << "\n" << text;
    EXPECT_NE(text.find("-v shows more"), std::string::npos) << words << "\n" << text;
    EXPECT_GT(lines_of(shown(words + " -v")).size(), lines_of(text).size()) << words;
  }
}

TEST_F(TerminalTest, SupportAndVerdictsHaveColorsThere) {
  const std::string words = "rank " + std::string(kView) + "--out c -t msaa4x --reference 2 -g gtx980 ";
  const std::string colored = shown(words);
  EXPECT_TRUE(std::regex_search(colored, std::regex("\x1b\\[3[0-9]m(ok|at risk|unknown)\x1b\\[0m")))
      << colored;
  EXPECT_TRUE(std::regex_search(colored, std::regex("\x1b\\[3[0-9]m(inter|extra)polated\x1b\\[0m")))
      << colored;
  for (const std::string& plain : {shown(words, "NO_COLOR=1 TERM=xterm"), shown(words, "TERM=dumb"),
                                   shown(words + "--color never"), place.hwsim(words).out})
    EXPECT_EQ(plain.find('\x1b'), std::string::npos) << plain;
  EXPECT_NE(place.hwsim(words + "--color always").out.find('\x1b'), std::string::npos);
}

TEST_F(TerminalTest, PipesHaveEverythingAsWideAsItIs) {
  const std::string words = "run " + std::string(kView) + "--out b -t none,msaa4x";
  const std::string piped = place.hwsim(words).out;
  EXPECT_NE(piped.find("shaded samples"), std::string::npos) << "details";
  EXPECT_EQ(piped.find("-v shows more"), std::string::npos);
  EXPECT_EQ(shown(words).find("shaded samples"), std::string::npos);
}

// Who sits there is told what to ask next; a pipe is not.
TEST_F(TerminalTest, TheNextCommandIsNamed) {
  const std::string run = "run " + std::string(kView) + "--out results -t none ";
  const auto said = [&](const std::string& words) {
    return place
        .shell("TERM=xterm script -qec 'stty cols 80 rows 24; hwsim " + words + "' /dev/null </dev/null")
        .out;
  };
  EXPECT_NE(said(run).find("next: the same with --reference"), std::string::npos);
  EXPECT_NE(said(run + "--reference 2").find("next: hwsim report results"), std::string::npos);
  EXPECT_NE(said("explain " + std::string(kView) + "-t msaa4x").find("next: hwsim compare triangle.gltf"),
            std::string::npos);
  EXPECT_EQ(place.hwsim(run).err.find("next:"), std::string::npos);
}

}  // namespace
}  // namespace hwsim::cli::test
