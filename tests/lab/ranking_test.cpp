// The Pareto front of time and error, on numbers that a reader can judge by eye.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "lab/studies/ranking.h"

namespace hwsim::lab {
namespace {

RankedTechnique technique(double frame_ms, double flip_mean, std::string reason = {}) {
  RankedTechnique t;
  t.frame_ms = frame_ms;
  t.error = flip_mean;
  t.reason = std::move(reason);
  return t;
}

std::vector<bool> front(std::vector<RankedTechnique> techniques) {
  mark_pareto(techniques);
  std::vector<bool> marks;
  for (const RankedTechnique& t : techniques) marks.push_back(t.pareto);
  return marks;
}

TEST(ParetoFront, HoldsWhatNobodyBeatsInTimeAndError) {
  EXPECT_EQ(front({technique(1.0, 0.30), technique(2.0, 0.10), technique(2.5, 0.20), technique(4.0, 0.05)}),
            (std::vector{true, true, false, true}));
}

TEST(ParetoFront, EqualsDoNotBeatEachOther) {
  EXPECT_EQ(front({technique(1.0, 0.1), technique(1.0, 0.1)}), (std::vector{true, true}));
}

TEST(ParetoFront, AnAdvantageInOneIsEnoughWhereTheOtherIsEqual) {
  EXPECT_EQ(front({technique(1.0, 0.1), technique(1.0, 0.2)}), (std::vector{true, false}));
  EXPECT_EQ(front({technique(1.0, 0.1), technique(2.0, 0.1)}), (std::vector{true, false}));
}

TEST(ParetoFront, WhatCannotRunNeitherStandsOnItNorPushesOthersOff) {
  EXPECT_EQ(front({technique(0.0, 0.0, "the GPU lacks a feature"), technique(1.0, 0.1)}),
            (std::vector{false, true}));
}

Ranking ranking_of(std::vector<RankedTechnique> techniques) {
  Ranking ranking;
  ranking.techniques = std::move(techniques);
  return ranking;
}

RankedTechnique judged(const std::string& name, const std::string& verdict, double error, double aa_ms) {
  RankedTechnique t = technique(1.0, error, verdict == "unsupported" ? "no" : "");
  t.technique = name;
  t.verdict = verdict;
  t.aa_ms = aa_ms;
  return t;
}

TEST(Overall, TakesTheWorstVerdictTheLargestCostAndTheMeanError) {
  const auto all = overall({ranking_of({judged("a", "ok", 0.1, 0.5), judged("b", "unknown", 0.01, 0.1)}),
                            ranking_of({judged("a", "at risk", 0.3, 0.4), judged("b", "over time", 0.01, 9.0),
                                        judged("c", "unsupported", 0.0, 0.0)})});
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].technique, "a");
  EXPECT_EQ(all[0].verdict, "at risk");
  EXPECT_DOUBLE_EQ(all[0].error_mean, 0.2);
  EXPECT_DOUBLE_EQ(all[0].aa_ms_most, 0.5);
  EXPECT_EQ(all[1].verdict, "over time");
  EXPECT_EQ(all[2].rankings, 0u) << "it runs nowhere";
}

TEST(Overall, TimesWithoutIntervalsAreOrderedByTheirErrorAmongThoseThatCostNothing) {
  const auto all = overall({ranking_of({judged("none", "ok", 0.3, 0.0), judged("a", "unknown", 0.1, 0.5)}),
                            ranking_of({judged("none", "ok", 0.3, 0.0), judged("a", "ok", 0.1, 0.4)})});
  EXPECT_EQ(all[0].technique, "a");
  EXPECT_EQ(all[0].verdict, "unknown");
}

TEST(Overall, ShowsTheErrorAsItsMetricPrintsIt) {
  Ranking ranking = ranking_of({judged("a", "ok", -34.9494, 0.5)});
  ranking.metric = "psnr";
  ranking.edges = true;
  ranking.techniques[0].edges = EdgeError{0.1, 34.9494};
  const Table table = overall_table(overall({ranking, ranking}));
  EXPECT_EQ(table.columns.back().title, "mean edge PSNR dB");
  EXPECT_NE(to_csv(table).find(",34.9494"), std::string::npos) << to_csv(table);
  EXPECT_NE(answer_of({ranking, ranking}).find("PSNR at edges 34.95 dB in the mean"), std::string::npos)
      << answer_of({ranking, ranking});
  EXPECT_NE(answer_of({ranking}).find("PSNR at edges 34.95 dB, "), std::string::npos);
}

TEST(EdgeError, CountsPixelsWhereTheReferenceHasEdgesAlone) {
  pipeline::Image reference(16, 4), image(16, 4), flip(16, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 16; ++x) {
      const float value = x < 8 ? 0.0f : 1.0f;
      reference.at(x, y) = image.at(x, y) = glm::vec4(value);
      flip.at(x, y) = glm::vec4(x == 7 ? 0.5f : 0.0f);
    }
  const std::vector<char> mask = edge_mask(reference);
  EXPECT_EQ(std::ranges::count(mask, 1), 4 * 4) << "two columns at the edge, and one more on each side";
  EXPECT_EQ(edge_error(image, reference, flip, mask).psnr_db, 999.0);
  EXPECT_NEAR(edge_error(image, reference, flip, mask).flip_mean, 0.125, 1e-7);
  for (int y = 0; y < 4; ++y) image.at(7, y) = glm::vec4(1.0f);
  EXPECT_NEAR(edge_error(image, reference, flip, mask).psnr_db, 10.0 * std::log10(4.0), 1e-5);
  image.at(0, 0) = glm::vec4(1.0f);  // far from the edge
  EXPECT_NEAR(edge_error(image, reference, flip, mask).psnr_db, 10.0 * std::log10(4.0), 1e-5);
}

ShownImage erring(const std::string& label, int x) {
  ShownImage image{label, 32, 8, std::vector<std::uint32_t>(32 * 8), std::vector<float>(32 * 8, 0.0f)};
  for (int y = 0; y < 8; ++y) {
    for (int all = 0; all < 8; ++all) image.error[static_cast<std::size_t>(y * 32 + all)] = 0.9f;
    image.error[static_cast<std::size_t>(y * 32 + x)] = 0.3f;
  }
  return image;
}

TEST(Regions, AreWhereTheTechniquesDifferNotWhereAllErrAlike) {
  const std::vector<ShownImage> images = {erring("a", 18), erring("b", 20)};
  const std::vector<Region> regions = worst_regions(images, 8, 1);
  ASSERT_EQ(regions.size(), 1u);
  EXPECT_GE(regions[0].x, 13);
  EXPECT_LE(regions[0].x, 18);
  EXPECT_EQ(worst_regions(std::span(images).first(1), 8, 1)[0].x, 0) << "one image alone: where it errs most";
}

}  // namespace
}  // namespace hwsim::lab
