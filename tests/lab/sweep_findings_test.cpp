// What a sweep found, on tables whose answer is known: times that are products of what the axes say.
#include "lab/studies/sweep_findings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lab/point/image_errors.h"

namespace hwsim::lab {
namespace {

/// A sweep of techniques by clocks by scenes, as its database gives it.
class FindingsTest : public ::testing::Test {
 protected:
  FindingsTest()
      : table_{{{"scene", ""},
                {"technique", ""},
                {"gpu", ""},
                {"width_px", ""},
                {"height_px", ""},
                {"gpu.core_clock_mhz", ""},
                {"state", ""},
                {"time_ms", ""},
                {"lo_ms", ""},
                {"hi_ms", ""},
                {"memory_mib", ""},
                {"flip_mean", ""},
                {"psnr_db", ""}},
               {}} {}
  void add(const std::string& scene, const std::string& technique, const std::string& clock, double time_ms,
           double flip = 0.1, const std::string& state = "done") {
    table_.rows.push_back({scene, technique, std::string("gtx980"), std::uint64_t{64}, std::uint64_t{48},
                           clock, state, Real{time_ms}, Real{time_ms / 2.0}, Real{time_ms * 3.0}, Real{8.0},
                           Real{flip}, Real{30.0}});
  }
  SweepFindings findings() const { return findings_of(rows_of(table_)); }
  static double share(const SweepFindings& found, const std::string& axis) {
    for (const AxisEffect& effect : found.effects)
      if (effect.axis == axis) return effect.share_ratio;
    return -1.0;
  }
  Table table_;
};

// ln(time) = ln(technique) + ln(clock): a balanced grid's variance is the sum of the two.
TEST_F(FindingsTest, SharesOfAProductAreThoseOfItsFactors) {
  for (const auto& [technique, factor] : {std::pair("none", 1.0), {"msaa4x", std::exp(3.0)}})
    for (const auto& [clock, time] : {std::pair("1000", std::exp(1.0)), {"2000", 1.0}})
      add("hall", technique, clock, factor * time);
  const SweepFindings found = findings();
  ASSERT_EQ(found.effects.size(), 2u) << "scene and GPU stay";
  EXPECT_NEAR(share(found, "technique"), 0.9, 1e-12);  // 3^2 of 3^2 + 1^2
  EXPECT_NEAR(share(found, "gpu.core_clock_mhz"), 0.1, 1e-12);
  EXPECT_EQ(found.effects.front().axis, "technique");
  EXPECT_EQ(found.effects.front().fastest, "none");
  EXPECT_EQ(found.effects.back().slowest, "1000");
  EXPECT_NEAR(found.effects.back().slowest_ms / found.effects.back().fastest_ms, std::exp(1.0), 1e-12);
}

TEST_F(FindingsTest, ChoicesAreJudgedOverAllFrames) {
  add("hall", "none", "1000", 1.0);
  add("wires", "none", "1000", 16.0);
  add("hall", "fxaa", "1000", 2.0);
  add("wires", "fxaa", "1000", 2.0);
  add("hall", "msaa4x", "1000", 0.1);  // not drawn with the other scene
  const SweepFindings found = findings();
  EXPECT_EQ(found.frames, 2u);
  ASSERT_EQ(found.best.size(), 2u);
  EXPECT_EQ(found.best[0].what.front().second, "fxaa");
  EXPECT_NEAR(found.best[0].time_ms, 2.0, 1e-12);
  EXPECT_NEAR(found.best[1].time_ms, 4.0, 1e-12) << "the geometric mean of 1 and 16";
  EXPECT_NEAR((*found.best[1].interval_ms)[0], 2.0, 1e-12);
  EXPECT_NEAR((*found.best[1].interval_ms)[1], 12.0, 1e-12);
}

TEST_F(FindingsTest, FrontHoldsWhatNobodyBeats) {
  add("hall", "none", "1", 1.0, 0.3);
  add("hall", "fxaa", "1", 2.0, 0.1);
  add("hall", "smaa", "1", 2.5, 0.2);
  add("hall", "ssaa4x", "1", 4.0, 0.05);
  const SweepFindings found = findings();
  ASSERT_EQ(found.front.size(), 3u);
  EXPECT_EQ(found.front[1].what.front().second, "fxaa");
  EXPECT_EQ(found.front[2].what.front().second, "ssaa4x");
}

TEST_F(FindingsTest, PointsThatAreNotDoneSayNothing) {
  add("hall", "none", "1", 1.0);
  add("hall", "fxaa", "1", 0.5, 0.1, "failed");
  EXPECT_EQ(findings().points, 1u);
  EXPECT_TRUE(findings().effects.empty());
  EXPECT_EQ(findings_of({}).points, 0u);
}

TEST_F(FindingsTest, ManyNumbersOfAnAxisAreBinned) {
  for (int i = 0; i < 800; ++i) add("hall", "none", std::to_string(1000 + i), 1000.0 / (1000 + i));
  const SweepFindings found = findings();
  ASSERT_EQ(found.effects.size(), 1u);
  EXPECT_EQ(found.effects[0].values, 800u);
  EXPECT_EQ(found.effects[0].fastest, "1700..1799");
  EXPECT_EQ(found.effects[0].slowest, "1000..1100");
  EXPECT_GT(found.effects[0].share_ratio, 0.97) << "what is lost within eight bins is a sixty-fourth";
  EXPECT_LT(found.effects[0].share_ratio, 1.0);
}

TEST(ImageErrors, AreComputedOnceForAFrameAndAReference) {
  const auto frame = std::make_shared<pipeline::Emulation>();
  frame->color = pipeline::Image(16, 16);
  ReferenceImage reference, other;
  reference.image = other.image = pipeline::Image(16, 16);
  ImageErrors errors(1);
  errors.of(frame, reference);
  EXPECT_EQ(errors.of(frame, reference).error.psnr_db, 999.0) << "equal images";
  EXPECT_EQ(errors.computed(), 1u);
  errors.of(frame, other);
  errors.of(std::make_shared<pipeline::Emulation>(*frame), reference);
  EXPECT_EQ(errors.computed(), 3u);
}

}  // namespace
}  // namespace hwsim::lab
