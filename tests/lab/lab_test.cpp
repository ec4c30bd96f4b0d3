// The lab as a program uses it: each question on a scene of one triangle.
#include "lab/lab.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "hwsim/config/settings.h"
#include "lab/workbench.h"

namespace hwsim::lab {
namespace {

using test::Listener;
using test::Workbench;

std::vector<std::string> codes_of(const InputError& error) {
  std::vector<std::string> codes;
  for (const Diagnostic& diagnostic : error.diagnostics()) codes.push_back(diagnostic.code);
  return codes;
}

/// The codes of the InputError that `question` ends in; empty when it ends in none.
template <class Question>
std::vector<std::string> mistakes(const Question& question) {
  try {
    question();
  } catch (const InputError& error) {
    return codes_of(error);
  }
  return {};
}

const RankedTechnique& find(const Ranking& ranking, const std::string& technique) {
  const auto found = std::ranges::find(ranking.techniques, technique, &RankedTechnique::technique);
  if (found == ranking.techniques.end()) throw std::runtime_error("not ranked: " + technique);
  return *found;
}

TEST(Lab, RunGivesAResultForEachTechniqueOnEachGpu) {
  const Workbench bench;
  const lab::Run run = Lab().run(bench.request({"none", "msaa4x"}, {"gtx980", "hd5870"}));
  EXPECT_EQ(run.scene, "triangle");
  EXPECT_EQ(run.resolution, (Resolution{64, 48}));
  std::vector<std::string> names;
  for (const Result& result : run.results) {
    names.push_back(result.technique + "@" + result.gpu);
    double passes_ms = 0.0;
    for (const PassResult& pass : result.passes) passes_ms += pass.time_ms;
    EXPECT_NEAR(passes_ms, result.frame.time_ms, 1e-9 * passes_ms) << names.back();
    EXPECT_GT(result.frame.shaded_samples, 0u);
    EXPECT_FALSE(result.image) << "no reference was asked for";
  }
  EXPECT_EQ(names,
            (std::vector<std::string>{"none@gtx980", "none@hd5870", "msaa4x@gtx980", "msaa4x@hd5870"}));
}

TEST(Lab, SecondQuestionIsAnsweredFromWhatTheFirstLoaded) {
  const Workbench bench;
  Listener listener;
  Lab lab({.use_cache = false, .observer = &listener});
  const lab::Run first = lab.run(bench.request());
  const std::size_t notes = listener.reported.size();
  EXPECT_GT(notes, 0u) << "the loader adds a camera and a light";
  const lab::Run second = lab.run(bench.request());
  EXPECT_FALSE(first.results.front().from_cache);
  EXPECT_TRUE(second.results.front().from_cache) << "the work was counted by this lab";
  EXPECT_EQ(listener.reported.size(), notes) << "the scene was loaded twice";
  EXPECT_EQ(first.results.front().frame.time_ms, second.results.front().frame.time_ms);
}

struct Images : RunSink {
  void begin(const RunContext& run) override {
    ++begun;
    with_reference = run.reference != nullptr;
  }
  void point(const PointResult& point, const RunContext&) override {
    widths.push_back(point.emulation->color.width);
  }
  int begun = 0;
  bool with_reference = false;
  std::vector<int> widths;
};

TEST(Lab, SinkIsGivenEveryPointWithItsImageAndTheReferenceBefore) {
  const Workbench bench;
  Request request = bench.request({"none", "ssaa4x"});
  request.settings.images = true;
  request.settings.reference_samples = 64;
  Images images;
  const lab::Run run = Lab().run(request, &images);
  EXPECT_EQ(images.begun, 1);
  EXPECT_TRUE(images.with_reference);
  EXPECT_EQ(images.widths, (std::vector<int>{64, 64}));
  ASSERT_TRUE(run.results.front().image && run.results.back().image);
  EXPECT_LT(run.results.back().image->flip_mean, run.results.front().image->flip_mean)
      << "supersampling is closer to the reference";
}

TEST(Lab, ProgressCountsAllPointsAndEndsWithAnErrorToo) {
  const Workbench bench;
  Listener listener;
  Lab lab({.observer = &listener});
  lab.run(bench.request({"none", "msaa4x"}));
  EXPECT_TRUE(std::ranges::is_sorted(listener.done));
  EXPECT_EQ(listener.done.back(), 1.0);
  EXPECT_EQ(listener.last, "msaa4x on gtx980");
  EXPECT_EQ(listener.ends, 1);
  EXPECT_EQ(mistakes([&] { lab.run(bench.request({"agaa"}, {"hd5870"})); }),
            std::vector<std::string>{"G006"});
  EXPECT_EQ(listener.ends, 2);
}

TEST(Lab, CompareSaysWhatAVariationChangesAgainstTheRequest) {
  const Workbench bench;
  Listener listener;
  const Comparison comparison =
      Lab({.observer = &listener})
          .compare(bench.request(), {{"half the clock", {}, {parse_assignment("gpu.core_clock_mhz=x0.5")}},
                                     {"the same", {}, {}}});
  EXPECT_EQ(comparison.baseline_label, "baseline");
  ASSERT_EQ(comparison.differences.size(), 2u);
  const Difference& slower = comparison.differences[0];
  EXPECT_EQ(slower.label, "half the clock");
  EXPECT_GT(slower.time_ms.after, slower.time_ms.before);
  EXPECT_EQ(slower.time_ms.before, comparison.baseline.frame.time_ms);
  for (const PassDifference& pass : slower.passes) EXPECT_TRUE(pass.counters.empty()) << pass.name;
  const Difference& same = comparison.differences[1];
  EXPECT_EQ(same.time_ms.after, same.time_ms.before);
  EXPECT_FALSE(listener.said.empty()) << "the plan comes first";
}

TEST(Lab, CompareNamesPointsWhereThereAreSeveral) {
  const Workbench bench;
  const Comparison comparison = Lab().compare(bench.request({"none", "msaa4x"}), {{"rops", {"rops-x2"}, {}}});
  EXPECT_EQ(comparison.baseline_label, "none on gtx980");
  std::vector<std::string> labels;
  for (const Difference& difference : comparison.differences) labels.push_back(difference.label);
  EXPECT_EQ(labels,
            (std::vector<std::string>{"msaa4x on gtx980", "none on gtx980 rops", "msaa4x on gtx980 rops"}));
}

TEST(Lab, CompareReportsTheMistakesOfAllVariationsBeforeItRuns) {
  const Workbench bench;
  EXPECT_EQ(mistakes([&] { Lab().compare(bench.request()); }), std::vector<std::string>{"U002"});
  const std::vector<Variation> wrong = {{"a", {"no-such-overlay"}, {}},
                                        {"b", {}, {parse_assignment("scene.lights=dim")}}};
  EXPECT_EQ(mistakes([&] { Lab().compare(bench.request(), wrong); }),
            (std::vector<std::string>{"U018", "U003"}));
}

TEST(Lab, RankPutsTechniquesWithinTheBudgetFirstAndNoneAmongThem) {
  const Workbench bench;
  Request request = bench.request({"ssaa64x", "msaa4x"});
  request.settings.reference_samples = 4;
  Lab lab;
  const Ranking ranking = lab.rank(request, "extra_mib<=1");
  ASSERT_EQ(ranking.techniques.size(), 3u);
  EXPECT_EQ(find(ranking, "none").aa_ms, 0.0);
  EXPECT_EQ(find(ranking, "none").extra_mib, 0.0);
  EXPECT_EQ(find(ranking, "ssaa64x").verdict, "over memory");
  EXPECT_EQ(ranking.techniques.back().technique, "ssaa64x");
  EXPECT_EQ(ranking.techniques.front().technique, "msaa4x") << "the least error of those within the budget";
  EXPECT_FALSE(ranking.regions) << "there are no images";
  EXPECT_EQ(mistakes([&] { lab.rank(request, "beauty<=1"); }), std::vector<std::string>{"U022"});
  request.gpus = {"gtx980", "hd5870"};
  EXPECT_EQ(mistakes([&] { lab.rank(request); }), std::vector<std::string>{"U004"});
}

// A filter comes behind the passes that `none` has too: these are as wrong in both frames, however long they
// take.
TEST(Lab, RankAndCompareKnowWhatAFilterAddsAsWellAsItsOwnPasses) {
  const Workbench bench;
  Request request = bench.request({"none", "fxaa", "msaa4x"});
  request.settings.reference_samples = 4;
  Lab lab;
  const auto extra = [&](const std::string& technique) {
    const Ranking ranking = lab.rank(request);
    const RankedTechnique& ranked = find(ranking, technique);
    EXPECT_LT((*ranked.aa_interval_ms)[0], ranked.aa_ms);
    EXPECT_GT((*ranked.aa_interval_ms)[1], ranked.aa_ms);
    return *ranked.aa_interval_ms;
  };
  EXPECT_GT(extra("fxaa")[0], 0.0);
  request.view.point_lights = 16;  // `none` takes longer, what FXAA does to it does not
  const std::array<double, 2> lit = extra("fxaa");
  request.view.point_lights = 0;
  EXPECT_NEAR(lit[1] / lit[0], extra("fxaa")[1] / extra("fxaa")[0], 0.1 * lit[1] / lit[0]);
  const Comparison comparison = lab.compare(request);
  EXPECT_GT((*comparison.differences[0].time_change_interval)[0], 0.0) << comparison.differences[0].label;
}

TEST(Lab, CompareKnowsOnWhichSideOfNothingAChangeOfHardwareLies) {
  const Workbench bench;
  Lab lab;
  const auto ends = [&](const std::string& path, const std::string& value) {
    const Comparison comparison = lab.compare(bench.request(), {{"changed", {}, {{path, value}}}});
    return *comparison.differences.at(0).time_change_interval;
  };
  EXPECT_GE(ends("gpu.dram_bandwidth_gb_s", "x0.5")[0], 0.0);
  EXPECT_GT(ends("gpu.dram_bandwidth_gb_s", "x0.5")[1], 0.0);
  EXPECT_LE(ends("gpu.l2_size_kib", "x4")[1], 0.0);
}

TEST(Lab, RankKeepsTechniquesThatCannotRunWithTheReason) {
  const Workbench bench;
  Request request = bench.request({"agaa", "msaa4x"}, {"hd5870"});
  request.settings.reference_samples = 4;
  const Ranking ranking = Lab().rank(request);
  const RankedTechnique& unsupported = ranking.techniques.back();
  EXPECT_EQ(unsupported.technique.rfind("agaa", 0), 0u);
  EXPECT_EQ(unsupported.verdict, "unsupported");
  EXPECT_FALSE(unsupported.runs());
  EXPECT_FALSE(unsupported.pareto);
  EXPECT_TRUE(ranking.techniques.front().pareto) << "the least error is never beaten";
}

TEST(Lab, RankShowsTheWorstRegionsOfImagesSideBySide) {
  const Workbench bench;
  Request request = bench.request({"msaa4x"});
  request.settings.reference_samples = 4;
  request.settings.images = true;
  pipeline::Image sheet;
  const Ranking ranking = Lab().rank(request, "", nullptr, &sheet);
  ASSERT_TRUE(ranking.regions);
  EXPECT_GE(ranking.regions->size(), 1u);
  EXPECT_GT(sheet.height, 3 * ranking.regions->front().side) << "reference, none and msaa4x";
}

TEST(Lab, ExplainDividesEachPassAmongUnitsAndTakesThemAway) {
  const Workbench bench;
  const std::vector<Explanation> explanations = Lab().explain(bench.request({"none", "msaa4x"}));
  ASSERT_EQ(explanations.size(), 2u);
  for (const Explanation& explanation : explanations) {
    for (std::size_t i = 0; i < explanation.stack_ms.size(); ++i) {
      double sum_ms = 0.0;
      for (const auto& [unit, time_ms] : explanation.stack_ms[i]) sum_ms += time_ms;
      const PassResult& pass = explanation.result.passes[i];
      EXPECT_NEAR(sum_ms, pass.time_ms, 1e-9 * pass.time_ms) << pass.name;
    }
    ASSERT_FALSE(explanation.headroom.empty());
    EXPECT_LT(explanation.headroom.front().time_ms, explanation.analyzed_ms);
    EXPECT_EQ(explanation.analyzed_ms, explanation.result.frame.time_ms);
    EXPECT_GT(limiter_share_ratio(explanation), 0.0);
    EXPECT_LE(limiter_share_ratio(explanation), 1.0);
  }
  EXPECT_EQ(compare(explanations, nullptr).differences.front().label, "msaa4x on gtx980");
}

TEST(Lab, SweepRunsWhatIsPlannedAndNothingTwice) {
  const Workbench bench;
  Lab lab;
  const PointSettings clocks(parse_axes({"gpu.core_clock_mhz=800,1600"}), Combine::grid);
  const SweepPlan points = lab.plan_sweep(bench.request({"none", "msaa4x"}), clocks);
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(collected(planned_rows(points)).rows.size(), 4u);
  const std::string database = bench.path("sweep.sqlite");
  const SweepSummary half = lab.sweep(points, {.database = database, .shard = parse_shard("1/2")});
  EXPECT_EQ(half.done, 2u);
  EXPECT_EQ(half.left, 2u);
  const SweepSummary whole = lab.sweep(points, {.database = database, .resume = true});
  EXPECT_EQ(whole.done, 4u);
  EXPECT_EQ(whole.left + whole.failed, 0u);
  EXPECT_EQ(collected(whole.points).rows.size(), 4u);
  EXPECT_EQ(mistakes([&] { lab.sweep(points, {.database = database}); }), std::vector<std::string>{"U013"});
  EXPECT_EQ(lab.sweep({}, {.database = database}).done, 4u) << "without points it is only read";
}

TEST(Lab, SweepReportsTheMistakesOfItsPointsBeforeItRuns) {
  const Workbench bench;
  const auto mistakes_of = [&](const std::vector<std::string>& axes) {
    return mistakes([&] { Lab().plan_sweep(bench.request(), {parse_axes(axes), Combine::grid}); });
  };
  EXPECT_EQ(mistakes_of({"gpu.core_clok_mhz=800,900"}).size(), 2u);
  const std::string clocks = "gpu.core_clock_mhz=500..1500:1000";
  EXPECT_EQ(mistakes_of({clocks, "gpu.l2_size_kib=512,-1,many"}), (std::vector<std::string>{"C014", "C013"}))
      << "not once for each clock";
}

// Neither value is wrong alone.
TEST(Lab, SweepNamesThePointOfAProductThatIsWrongAsAWhole) {
  const Workbench bench;
  try {
    Lab().plan_sweep(
        bench.request(),
        {parse_axes({"gpu.tex_64bit_ratio=0.25,0.5", "gpu.tex_128bit_ratio=0.2,0.4"}), Combine::grid});
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), 1u);
    EXPECT_EQ(error.diagnostics().front().code, "C018");
    EXPECT_EQ(error.diagnostics().front().notes.back(),
              "point 2: gpu.tex_64bit_ratio=0.25 gpu.tex_128bit_ratio=0.4");
  }
}

TEST(Lab, PlannedPointsAreTheSameInWhateverOrderTheyAreAskedFor) {
  const Workbench bench;
  Lab lab;
  const PointSettings settings(parse_axes({"gpu.core_clock_mhz=800,1600", "scene.exposure=1,2"}),
                               Combine::grid);
  const SweepPlan plan = lab.plan_sweep(bench.request(), settings);
  ASSERT_EQ(plan.size(), 4u);
  const std::vector<std::string> ids = {plan[0].id, plan[1].id, plan[2].id, plan[3].id};
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), 4u);
  for (const std::size_t i : {3u, 0u, 2u, 1u}) EXPECT_EQ(plan.row(i).id, ids[i]);
  EXPECT_EQ(plan.order(), (std::vector<std::uint32_t>{0, 2, 1, 3}))
      << "points that share an emulation together";
}

TEST(Lab, ShardIsAPartOfAWhole) {
  EXPECT_EQ(parse_shard("2/3").index, 1u);
  EXPECT_EQ(parse_shard("2/3").count, 3u);
  for (const char* text : {"0/3", "4/3", "1", "a/b", "1/2/3", "-1/2", "1/10000000"})
    EXPECT_EQ(mistakes([&] { parse_shard(text); }), std::vector<std::string>{"U003"}) << text;
}

TEST(Lab, PairThatCannotRunIsRefusedBeforeAnythingIsDrawn) {
  const Workbench bench;
  Listener listener;
  Lab lab({.observer = &listener});
  const Request request = bench.request({"none", "msaa32x"}, {"gtx980", "gtx470"});
  try {
    lab.run(request);
    ADD_FAILURE() << "no GTX 470 has 32 samples";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().front().code, "G006");
    EXPECT_NE(error.diagnostics().front().notes.back().find("msaa32x on gtx470"), std::string::npos);
  }
  EXPECT_TRUE(listener.done.empty() || listener.done.back() == 0.0) << "something was drawn";
}

TEST(Lab, ImageHasNoReference) {
  const Workbench bench;
  pipeline::write_image(pipeline::Image(8, 8), bench.path("image.png"));
  View view;
  view.scene = bench.path("image.png");
  EXPECT_THROW(Lab().reference(view, 4), InputError);
}

TEST(Lab, PlansEachViewUnderANameForItsFiles) {
  const Workbench bench;
  Lab lab;
  const PointSettings views(parse_axes({"resolution=16x8,32x16", "scene.lights=simple,complex"}),
                            Combine::grid);
  const std::vector<NamedPlan> plans = lab.plan_views(bench.request(), views);
  ASSERT_EQ(plans.size(), 4u);
  EXPECT_EQ(plans[1].name, "resolution-16x8-scene.lights-complex");
  EXPECT_EQ(plans[1].plan.view.resolution, (Resolution{16, 8}));
  EXPECT_EQ(plans[2].name, "resolution-32x16-scene.lights-simple");
  EXPECT_EQ(plans[2].plan.view.lights, "simple");
  EXPECT_EQ(lab.plan_views(bench.request(), {}).front().name, "") << "a request that is not varied";
  try {  // the mistakes of both views come together
    lab.plan_views(bench.request(), {parse_axes({"scene.lights=dim,bright"}), Combine::grid});
    ADD_FAILURE() << "no such lights";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().size(), 2u);
  }
}

TEST(Lab, SweepOverAnImageRecordsTheSizeOfTheImage) {
  const Workbench bench;
  pipeline::write_image(pipeline::Image(24, 16), bench.path("image.png"));
  Request request = bench.request({"fxaa"});
  request.view.scene = bench.path("image.png");
  Lab lab;
  const SweepPlan plan = lab.plan_sweep(request, {});
  ASSERT_EQ(plan.size(), 1u);
  EXPECT_EQ(plan.row(0).resolution, (Resolution{24, 16}));
}

}  // namespace
}  // namespace hwsim::lab
