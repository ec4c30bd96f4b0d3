#include "hwsim/config/toml_value.h"

#include <gtest/gtest.h>

#include "hwsim/base/diagnostics.h"
#include "hwsim/config/settings.h"

namespace hwsim {
namespace {

struct Sample {
  int depth = 4;
  double ratio = 0.5;
  bool skip = true;
  std::string mode = "all";
};

template <class V>
void describe(V& v, Sample& s) {
  v.key({"depth", 1, 8, kNoFlags, "depth of the sample"}, s.depth);
  v.key({"ratio", 0, 1, kNoFlags, "ratio of the sample"}, s.ratio);
  v.key({"skip", 0, 0, kNoFlags, "whether to skip"}, s.skip);
  v.key({"mode", 0, 0, kNoFlags, "what to do"}, s.mode);
}

std::string code_of(auto&& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.diagnostics().at(0).code;
  }
  return "none";
}

TEST(TomlValue, ScalarsHaveTheirTypeAndOtherTextIsBare) {
  EXPECT_EQ(parse_toml_value("true"), TomlValue(true));
  EXPECT_EQ(parse_toml_value("1_500"), TomlValue(std::int64_t{1500}));
  EXPECT_EQ(parse_toml_value("1e3"), TomlValue(1000.0));
  EXPECT_EQ(parse_toml_value("none"), TomlValue(std::string("none")));
  EXPECT_EQ(parse_toml_value("agaa:c=2"), TomlValue(std::string("agaa:c=2")));
  EXPECT_EQ(parse_toml_value("\"a b\""), TomlValue(std::string("a b")));
  EXPECT_EQ(parse_toml_value("#ff0000"), TomlValue(std::string("#ff0000")));
  EXPECT_EQ(parse_toml_value("5 # five"), TomlValue(std::string("5 # five")));
}

TEST(TomlValue, WhatIsNoScalarIsAnError) {
  for (const char* text : {"", "[1, 2]", "{ a = 1 }", "\"open", "1\nkey = 2", "1979-05-27", "'x", "[",
                           "99999999999999999999x\n"})
    EXPECT_EQ(code_of([&] { parse_toml_value(text); }), "C021") << text;
}

TEST(TomlValue, WritingReadsBackToTheSameBits) {
  for (const double number : {0.1, 1.0, 1e300, -2.5e-7, 1215.0 / 607.0, 133.9})
    EXPECT_EQ(parse_toml_value(to_toml(number)), TomlValue(number));
  for (const char* text : {"plain", "with \"quotes\"", "back\\slash", "tab\tline\nend", "it's"})
    EXPECT_EQ(parse_toml_value(to_toml(std::string(text))), TomlValue(std::string(text)))
        << to_toml(std::string(text));
}

TEST(Assignment, SplitsAtTheFirstEqualsSign) {
  const Assignment a = parse_assignment("technique.name = agaa:c=2");
  EXPECT_EQ(a.path, "technique.name");
  EXPECT_EQ(a.value, "agaa:c=2");
  EXPECT_EQ(a.group(), "technique");
  for (const char* text : {"gpu.x", "gpu=1", ".x=1", "gpu.=1", "=1", ""})
    EXPECT_EQ(code_of([&] { parse_assignment(text); }), "C020") << text;
}

TEST(Settings, AnyStructWithADescriptionTakesAssignments) {
  Sample sample;
  std::vector<Diagnostic> problems;
  const std::vector<Assignment> sets = {{"sample.depth", "7"},
                                        {"sample.ratio", "1"},
                                        {"sample.skip", "false"},
                                        {"sample.mode", "none"},
                                        {"other.depth", "x"}};
  apply_settings("sample", keys_of(sample), sets, problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(sample.depth, 7);
  EXPECT_EQ(sample.ratio, 1.0);
  EXPECT_FALSE(sample.skip);
  EXPECT_EQ(sample.mode, "none");
}

TEST(Settings, EveryBadAssignmentIsReportedAndChangesNothing) {
  Sample sample;
  std::vector<Diagnostic> problems;
  const std::vector<Assignment> sets = {{"sample.detph", "7"},   {"sample.depth", "9"},
                                        {"sample.depth", "1.5"}, {"sample.skip", "1"},
                                        {"sample.ratio", "[1]"}, {"sample.ratio", "nan"}};
  apply_settings("sample", keys_of(sample), sets, problems);
  ASSERT_EQ(problems.size(), 6u);
  const char* codes[] = {"C012", "C014", "C013", "C013", "C021", "C014"};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(problems[i].code, codes[i]) << problems[i].message;
  EXPECT_EQ(problems[0].hint, "did you mean `depth`?");
  EXPECT_EQ(problems[0].place.line_text, "--set sample.detph=7");
  EXPECT_EQ(sample.depth, 4);
  EXPECT_EQ(sample.ratio, 0.5);
}

TEST(Settings, GroupsThatNobodyReadsAreErrors) {
  const std::vector<std::string> groups = {"gpu", "technique"};
  EXPECT_EQ(code_of([&] { check_groups(std::vector<Assignment>{{"gpu.x", "1"}}, groups); }), "none");
  EXPECT_EQ(code_of([&] { check_groups(std::vector<Assignment>{{"techniqe.x", "1"}}, groups); }), "C020");
}

}  // namespace
}  // namespace hwsim
