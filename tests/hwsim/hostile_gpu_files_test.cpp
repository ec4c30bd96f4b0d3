// GPU files that somebody made to break the program, and wrong ones of every kind: each ends in few messages,
// and each message says where, what was meant and how to go on.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "hwsim/base/diagnostics.h"
#include "hwsim/config/toml_nesting.h"
#include "hwsim/config/toml_value.h"
#include "hwsim/gpu/gpu_config.h"
#include "hwsim/gpu/gpu_rules.h"
#include "hwsim/sample_gpu.h"

namespace hwsim::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHead = "schema = 1\nkind = \"gpu\"\nextends = \"base\"\n";

class HostileGpuFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    dir_ = fs::path(::testing::TempDir()) / (std::string("hwsim_hostile_") + test->name());
    fs::remove_all(dir_);
    fs::create_directories(dir_);
    write("base", show(sample_gpu(), false));
  }
  void TearDown() override { fs::remove_all(dir_); }

  void write(const std::string& id, const std::string& text) {
    std::ofstream(dir_ / (id + ".toml"), std::ios::binary) << text;
  }
  /// Every message of a file with this text; each is checked for its place and its remedy.
  std::vector<Diagnostic> messages(const std::string& text, std::vector<Assignment> sets = {}) {
    write("child", text);
    try {
      load_gpu("child", {}, sets, dir_.string());
    } catch (const InputError& error) {
      for (const Diagnostic& d : error.diagnostics()) {
        EXPECT_FALSE(d.place.file.empty()) << d.message;
        EXPECT_FALSE(d.help.empty()) << d.message;
        EXPECT_FALSE(d.code.empty()) << d.message;
        EXPECT_LT(render(d, false).size(), 2000u) << d.message.substr(0, 200);
      }
      return error.diagnostics();
    }
    return {};
  }
  std::string code(const std::string& text, std::vector<Assignment> sets = {}) {
    const auto found = messages(text, std::move(sets));
    return found.empty() ? "" : found.front().code;
  }

  fs::path dir_;
};

std::string repeated_text(const std::string& part, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += part;
  return text;
}

TEST_F(HostileGpuFiles, NestedTenThousandTimesTheyEndInOneMessage) {
  constexpr int kDeep = 10'000;
  const std::string dotted = repeated_text("a.", kDeep) + "a";
  for (const std::string& text :
       {dotted + " = 1\n", "[" + dotted + "]\nx = 1\n", "[[" + dotted + "]]\nx = 1\n",
        "x = { " + dotted + " = 1 }\n", repeated_text("a . ", kDeep) + "a = 1\n",
        repeated_text("\"a\" . 'b'.", kDeep) + "a = 1\n", "x = " + repeated_text("[", kDeep) + "\n",
        "x = " + repeated_text("{a = ", kDeep) + "1\n", "x = " + repeated_text("[\n", kDeep)}) {
    const auto found = messages(kHead + text);
    ASSERT_EQ(found.size(), 1u) << text.substr(0, 40);
    EXPECT_EQ(found[0].code, "C011");
    EXPECT_GE(found[0].place.line, 4);
  }
  for (const std::string& value : {repeated_text("[", kDeep), "{" + dotted + " = 1}", dotted})
    EXPECT_EQ(code(kHead, {{"gpu.draw_cycles", value}}).substr(0, 2), "C0") << value.substr(0, 40);
}

TEST(TomlNesting, SixteenLevelsPassAndSeventeenDoNot) {
  const std::string key = repeated_text("a.", kTomlLevelsMax - 1);
  EXPECT_FALSE(too_deep(key + "a = 1.5\n" + key + "a = 2.5\n"));
  const auto deep = too_deep("x = 1\n" + key + "a.a = 1\n");
  ASSERT_TRUE(deep);
  EXPECT_EQ(deep->line, 2);
  EXPECT_EQ(deep->column, 2 * kTomlLevelsMax);
  const std::string open = repeated_text("[", kTomlLevelsMax), close = repeated_text("]", kTomlLevelsMax);
  EXPECT_FALSE(too_deep("x = " + open + close + "\ny = " + open + close));
  EXPECT_TRUE(too_deep("x = [" + open + close + "]"));
  const std::string dots = repeated_text("..[{", 40);
  for (const std::string& text : {"# " + dots + "\nx = 1", "x = \"" + dots + "\"", "x = '" + dots + "'",
                                  "x = \"\"\"" + dots + "\n\"" + dots + "\"\"\"",
                                  "x = '''" + dots + "\n" + dots + "'''", "x = \"\\\"" + dots + "\""})
    EXPECT_FALSE(too_deep(text)) << text;
  EXPECT_TRUE(too_deep("x = \"a\"\n" + dots));
}

TEST_F(HostileGpuFiles, AHundredThousandUnknownKeysEndInTwentyMessages) {
  std::string lines, one_line = "x = {";
  for (int i = 0; i < 100'000; ++i) {
    lines += "crop_unit" + std::to_string(i) + " = 1\n";
    one_line += (i > 0 ? ", k" : "k") + std::to_string(i) + " = 1";
  }
  for (const std::string& text : {kHead + lines, kHead + one_line + "}\n"}) {
    const auto found = messages(text);
    ASSERT_EQ(found.size(), kProblemsShown);
    EXPECT_EQ(found.back().message, "99981 further problems are not listed");
  }
  EXPECT_EQ(code(kHead + std::string(3u << 20, 'k') + " = 1\n"), "C012");
}

TEST_F(HostileGpuFiles, ExtendEachOtherSixteenTimesAndNoMore) {
  const auto chain = [this](int files) {
    for (int i = 0; i < files; ++i)
      write("f" + std::to_string(i), "schema = 1\nkind = \"gpu\"\nextends = \"" +
                                         (i == 0 ? "base" : "f" + std::to_string(i - 1)) + "\"\n");
    return messages("schema = 1\nkind = \"gpu\"\nextends = \"f" + std::to_string(files - 1) + "\"\n");
  };
  EXPECT_TRUE(chain(14).empty());
  for (const int files : {15, 1000}) {
    const auto found = chain(files);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].code, "C017");
  }
}

TEST_F(HostileGpuFiles, LargerThanFourMebibytesTheyAreNotRead) {
  EXPECT_EQ(code(kHead + std::string((4u << 20) - 100, '#')), "");
  EXPECT_EQ(code(kHead + std::string(4u << 20, '#')), "C010");
}

TEST_F(HostileGpuFiles, NameNoOtherFolder) {
  for (const char* id : {"../x", "a/b", "a\\\\b", ".", "..", "a\\nb", "a\\u001bb"})
    EXPECT_EQ(code(std::string(kHead) + "id = \"" + id + "\"\n"), "C019") << id;
  EXPECT_EQ(code(kHead + ("id = \"" + std::string(65, 'x')) + "\"\n"), "C019");
  EXPECT_EQ(code(kHead + ("id = \"" + std::string(64, 'x')) + "\"\n"), "");
}

TEST(GpuIds, ThatNameOneFolderAreRefusedAndTheSameGpuTwiceIsNot) {
  const auto problems = [](const std::string& id, double mhz) {
    std::vector<GpuConfig> gpus(2, sample_gpu());
    gpus[1].id = id;
    gpus[1].core_clock_mhz = mhz;
    std::vector<Diagnostic> found;
    check_ids(gpus, found);
    for (const Diagnostic& d : found) EXPECT_EQ(d.code, "C023");
    return found.size();
  };
  EXPECT_EQ(problems("sample", 1000.0), 0u);
  EXPECT_EQ(problems("sample", 900.0), 1u);
  EXPECT_EQ(problems("sample2", 1000.0), 0u);
  std::vector<GpuConfig> folded(2, sample_gpu());
  folded[0].id = "a b";
  folded[1].id = "a:b";
  std::vector<Diagnostic> found;
  check_ids(folded, found);
  EXPECT_EQ(found.size(), 1u);
}

TEST_F(HostileGpuFiles, WrongValuesOfEveryKindSayWhereWhatAndHow) {
  for (const char* line : {"core_clock_mhz = -5",
                           "core_clock_mhz = nan",
                           "core_clock_mhz = inf",
                           "core_clock_mhz = -inf",
                           "core_clock_mhz = 1e400",
                           "core_clock_mhz = \"x-2\"",
                           "core_clock_mhz = \"xinf\"",
                           "core_clock_mhz = \"fast\"",
                           "core_clock_mhz = [1]",
                           "core_clock_mhz = 1979-05-27",
                           "core_clock_mhz = true",
                           "core_clock_mhz = {}",
                           "core_clock_mhz = { value = [1] }",
                           "core_clock_mhz = { value = nan }",
                           "queue_packets = 9223372036854775807",
                           "queue_packets = -9223372036854775808",
                           "crop_units = 2.5",
                           "tile_based = 1",
                           "title = 3",
                           "draw_cycles = { value = 1, interval = [0, nan] }",
                           "draw_cycles = { value = 1, interval = [2, 3] }",
                           "draw_cycles = { value = 1, source = 5 }",
                           "draw_cycles = { value = 1, provenance = \"fited\" }",
                           "draw_cycles = { value = 1, sourec = \"x\" }",
                           "crop_unit = 1",
                           "= 1",
                           "x",
                           "x = ",
                           "[x",
                           "x = \"",
                           "draw_cycles = 1\ndraw_cycles = 2",
                           "\xff = 1",
                           "x = \"\xff\"",
                           "extends = 3",
                           "id = 3",
                           "schema = 2",
                           "kind = \"run\"",
                           "vliw_slots = 3\nvliw_fill_slots = 4",
                           "subgroup_size = 48",
                           "tex_128bit_ratio = 0.9"})
    EXPECT_FALSE(messages(std::string(kHead) + line + "\n").empty()) << line;
  EXPECT_FALSE(messages("").empty());
  EXPECT_FALSE(messages("schema = 1\nkind = \"gpu\"\nextends = \"bsae\"\n").empty());
  for (const char* value : {"nan", "inf", "1e999", "[", "\"", "x0", "", "{a = 1}", "1979-05-27"})
    EXPECT_FALSE(messages(kHead, {{"gpu.core_clock_mhz", value}}).empty()) << value;
}

}  // namespace
}  // namespace hwsim::test
