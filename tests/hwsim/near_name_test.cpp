// Hints: which known name an unknown one may mean.
#include <gtest/gtest.h>

#include "hwsim/base/diagnostics.h"
#include "hwsim/base/plain_name.h"

namespace hwsim::test {
namespace {

const std::vector<std::string> kNames = {"none",     "csaa",   "msaa2x",  "msaa4x", "smaa",
                                         "sbaa_top", "agaa",   "rtx4090", "gtx980", "rtx4070_laptop",
                                         "a",        "sss_gs", "wire_aa"};

TEST(NearName, CaseAndSeparatorsAreNoDifference) {
  EXPECT_EQ(plain_name("GTX 980-Ti_x"), "gtx980tix");
  for (const char* name : {"GTX 980", "gtx-980", "Gtx_980"})
    EXPECT_EQ(did_you_mean(name, kNames), "did you mean `gtx980`?") << name;
  EXPECT_EQ(nearest_name("WIRE AA", kNames), "wire_aa");
}

TEST(NearName, ABeginningBeatsAMistake) {
  EXPECT_EQ(nearest_name("sbaa", kNames), "sbaa_top") << "a letter away from csaa, smaa and agaa";
  EXPECT_EQ(nearest_name("rtx4070", kNames), "rtx4070_laptop") << "a letter away from rtx4090";
  EXPECT_EQ(did_you_mean("MSAA", kNames), "did you mean `msaa2x` or `msaa4x`?");
  EXPECT_EQ(nearest_name("sss", kNames), "sss_gs");
}

TEST(NearName, TheWholeNameBeatsALongerOne) {
  const std::vector<std::string> names = {"fxaa_fast", "FXAA"};
  EXPECT_EQ(did_you_mean("fxaa", names), "did you mean `FXAA`?");
}

TEST(NearName, MistakenLettersAreFoundAsBefore) {
  EXPECT_EQ(nearest_name("gtx981", kNames), "gtx980");
  EXPECT_EQ(nearest_name("MSAA5X", kNames), "msaa2x");
  EXPECT_EQ(nearest_name("nnoe", kNames), "none");
  EXPECT_EQ(nearest_name("sponza", kNames), "");
}

TEST(NearName, ALetterIsNoBeginning) {
  const std::vector<std::string> names = {"alpha", "anisotropy"};
  EXPECT_EQ(nearest_name("a", names), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name("_", names), "");
}

}  // namespace
}  // namespace hwsim::test
