// What holds for every filter, and how filters combine with what drew the frame.
#include <gtest/gtest.h>

#include "algos/picture.h"
#include "hwsim/base/diagnostics.h"

namespace hwsim::test {
namespace {

/// Those that smooth a finished picture; one of linear light changes every color.
std::vector<std::string> filters() {
  std::vector<std::string> all;
  for (const algos::TechniqueInfo& t : algos::techniques())
    if (t.kind() == algos::TechniqueKind::filter && !t.linear_input) all.emplace_back(t.id);
  return all;
}

class EveryFilter : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryFilter, LeavesConstantPictures) {
  for (const std::array<int, 3> color :
       {std::array{0, 0, 0}, std::array{255, 255, 255}, std::array{17, 130, 201}}) {
    const Picture p(75, 41, color);
    EXPECT_EQ(filter(p, GetParam()).picture, p);
  }
}

TEST_P(EveryFilter, ChangesEdgesAndLittleElse) {
  const Picture p = shapes(192, 120);
  const int changed = count_differences(filter(p, GetParam()).picture, p);
  EXPECT_GT(changed, 300);
  EXPECT_LT(changed, p.width * p.height / 3);
}

TEST_P(EveryFilter, WorksOnPicturesOfAPixel) {
  const Picture p(1, 1, {10, 20, 30});
  EXPECT_EQ(filter(p, GetParam()).picture, p);
}

INSTANTIATE_TEST_SUITE_P(Filters, EveryFilter, ::testing::ValuesIn(filters()),
                         [](const auto& parameter) { return parameter.param; });

TEST(PostFilters, AppliedInOrderAfterTheBase) {
  const algos::TechniqueChoice choice = algos::parse_technique("fxaa:preset=39+smaa+msaa4x");
  EXPECT_EQ(algos::technique_text(choice), "msaa4x+fxaa:preset=39+smaa");
  EXPECT_EQ(algos::technique_text(algos::parse_technique("none+fxaa")), "fxaa");
  EXPECT_EQ(algos::technique_text(algos::parse_technique("none:prepass=on+fxaa")), "none:prepass=on+fxaa");
  const Picture p = shapes(96, 72);
  EXPECT_EQ(filter(p, "fxaa+smaa").picture, filter(filter(p, "fxaa").picture, "smaa").picture);
}

TEST(PostFilters, FxaaHoldsTwoImagesAtATime) {
  const Picture p(64, 32);
  EXPECT_EQ(filter(p, "fxaa").trace.peak_memory_bytes, 64u * 32u * 8u);
  EXPECT_EQ(filter(p, "axaa:green_as_luma=on").trace.peak_memory_bytes, 64u * 32u * 8u);
}

TEST(PostFilters, ImagesAreNotDrawn) {
  const Picture p(8, 8);
  for (const char* technique : {"none", "msaa4x", "msaa4x+fxaa", "deferred+smaa"}) {
    try {
      algos::build_frame(algos::parse_technique(technique), image_request(p));
      ADD_FAILURE() << technique;
    } catch (const InputError& error) {
      EXPECT_EQ(error.diagnostics().front().code, "T005");
    }
  }
}

}  // namespace
}  // namespace hwsim::test
