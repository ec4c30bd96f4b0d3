// The grammar of techniques: parts, their order, their parameters, and what cannot be combined.
#include "algos/techniques.h"

#include <gtest/gtest.h>

#include "hwsim/base/diagnostics.h"

namespace hwsim::algos::test {
namespace {

std::vector<Diagnostic> problems_of(const std::string& text) {
  try {
    parse_technique(text);
  } catch (const InputError& error) {
    return error.diagnostics();
  }
  return {};
}

std::string codes(const std::string& text) {
  std::string all;
  for (const Diagnostic& d : problems_of(text)) all += (all.empty() ? "" : " ") + d.code;
  return all;
}

TEST(Technique, EveryEntryHasOneKindAndAnIdThatIsAWord) {
  for (const TechniqueInfo& t : techniques()) {
    EXPECT_EQ((t.build ? 1 : 0) + (t.modify ? 1 : 0) + (t.filter ? 1 : 0), 1) << t.id;
    EXPECT_EQ(t.id.find_first_of("+:=, "), std::string_view::npos) << t.id;
    for (const TechniqueInfo& other : techniques()) EXPECT_TRUE(&t == &other || t.id != other.id) << t.id;
    for (const OptionInfo& p : t.options)
      EXPECT_TRUE(p.default_value >= p.min && p.default_value <= p.max) << t.id << ":" << p.name;
  }
}

TEST(Technique, TextRoundTrips) {
  for (const TechniqueInfo& t : techniques()) {
    const TechniqueChoice choice = parse_technique(t.id);
    EXPECT_EQ(technique_text(choice), t.id);
    const TechniqueChoice again = parse_technique(technique_text(choice, true));
    EXPECT_EQ(technique_text(again, true), technique_text(choice, true));
    EXPECT_EQ(again.parts.size(), choice.parts.size());
  }
  EXPECT_EQ(technique_text(parse_technique("ssaa4x:variant=accumulate")), "ssaa4x:variant=accumulate");
}

TEST(Technique, MistakesAreReportedTogether) {
  EXPECT_EQ(codes("msaa3x:centroid=maybe"), "T001");
  EXPECT_EQ(codes("msaa4x:centroid=maybe,sample=4"), "T003 T002");
  EXPECT_EQ(codes("msaa4x:centroid"), "T002");
  EXPECT_EQ(codes("msaa4x+"), "T001");
  EXPECT_EQ(codes(""), "T001");
  EXPECT_EQ(codes("nnoe+msaa4x:sampels=4"), "T001 T002");
}

/// What an option takes is checked where it is read, not by the frame that it builds.
TEST(Technique, NumbersOfSamplesArePowersOfTwo) {
  std::size_t found = 0;
  for (const TechniqueInfo& t : techniques())
    for (const OptionInfo& option : t.options) {
      const bool is_fixed = option.choices.empty() && option.min == option.max;  // the name says it
      if (is_fixed || (option.name != "samples" && option.name != "msaa")) continue;
      ++found;
      EXPECT_EQ(codes(std::string(t.id) + ":" + std::string(option.name) + "=6"), "T003") << t.id;
      EXPECT_EQ(codes(std::string(t.id) + ":" + std::string(option.name) + "=8"), "") << t.id;
    }
  EXPECT_GE(found, 5u);
}

TEST(Technique, TwoBasesAreRefused) {
  EXPECT_EQ(codes("msaa4x+deferred"), "T004");
  EXPECT_EQ(codes("msaa4x+msaa4x"), "T004");
  EXPECT_NE(problems_of("msaa4x+deferred").front().message.find("draws the whole frame"), std::string::npos);
}

}  // namespace
}  // namespace hwsim::algos::test
