// What the lab answers is the same after JSON: nothing is lost, and what is unknown is ignored.
#include <gtest/gtest.h>

#include "cost_models/kept_traces.h"
#include "hwsim/config/settings.h"
#include "lab/base/files.h"
#include "lab/lab.h"
#include "lab/studies/published_runs.h"
#include "lab/workbench.h"
#include "support/places.h"

namespace hwsim::lab {
namespace {

using test::Workbench;
using Json = nlohmann::ordered_json;

/// As a file would bring it: as text.
Json through_text(const Json& json) { return Json::parse(json.dump()); }

TEST(AnswersJson, ResultOfAnImageAndASampledEngineComesBack) {
  const Workbench bench;
  Request request = bench.request({"msaa4x"});
  request.settings.reference_samples = 4;
  request.settings.engine = "detailed";
  request.settings.detailed_sample = 0.5;
  lab::Run run = Lab().run(request);
  run.results.front().warnings = {"a warning"};
  const Json json = to_json(run.results.front());
  EXPECT_FALSE(json["image"].is_null());
  EXPECT_EQ(to_json(result_from_json(through_text(json))), json);
  Json further = through_text(json);
  further["of_a_later_version"] = 1;
  EXPECT_EQ(to_json(result_from_json(further)), json);
}

TEST(AnswersJson, ResultWithoutANeededFieldIsRefused) {
  const Workbench bench;
  const Json json = to_json(Lab().run(bench.request()));
  for (const char* key : {"scene", "technique", "gpu", "frame", "passes"}) {
    Json cut = json;
    cut.erase(key);
    EXPECT_THROW(result_from_json(cut), Json::exception) << key;
  }
  Json wrong = json;
  wrong["frame"]["time_ms"] = "fast";
  EXPECT_THROW(result_from_json(wrong), Json::exception);
  for (const double value : {-5.0, -1e308, 0.5}) {
    wrong = json;
    wrong["passes"][0]["counters"]["raster.quads"] = value;
    EXPECT_THROW(result_from_json(wrong), Json::exception) << value;
  }
  for (const double value : {-5.0, -1e308}) {
    wrong = json;
    wrong["passes"][0]["bytes"]["depth"] = value;
    EXPECT_THROW(result_from_json(wrong), Json::exception) << value;
  }
}

TEST(AnswersJson, RunOfOneAndOfSeveralPointsComesBack) {
  const Workbench bench;
  Lab lab;
  for (const std::vector<std::string>& techniques :
       {std::vector<std::string>{"none"}, std::vector<std::string>{"none", "msaa4x"}}) {
    const lab::Run run = lab.run(bench.request(techniques));
    const lab::Run again = run_from_json(through_text(to_json(run)));
    EXPECT_EQ(to_json(again), to_json(run));
    EXPECT_EQ(again.scene, run.scene);
    EXPECT_EQ(again.resolution, run.resolution);
    EXPECT_EQ(again.results.size(), techniques.size());
  }
}

TEST(AnswersJson, ComparisonComesBackWithItsTables) {
  const Workbench bench;
  const Comparison comparison = Lab().compare(bench.request({"none", "msaa4x", "deferred"}));
  const Comparison again = comparison_from_json(through_text(to_json(comparison)));
  EXPECT_EQ(to_json(again), to_json(comparison));
  EXPECT_EQ(to_csv(frame_comparison(again)), to_csv(frame_comparison(comparison)));
  EXPECT_EQ(to_csv(pass_comparison(again)), to_csv(pass_comparison(comparison)));
  EXPECT_EQ(to_csv(counter_comparison(again)), to_csv(counter_comparison(comparison)));
}

TEST(AnswersJson, ExplanationComesBackWithItsTables) {
  const Workbench bench;
  for (const char* engine : {"queue", "detailed"}) {
    Request request = bench.request({"msaa4x"});
    request.settings.engine = engine;
    const Explanation explanation = Lab().explain(request).front();
    const Explanation again = explanation_from_json(through_text(to_json(explanation)));
    EXPECT_EQ(to_json(again), to_json(explanation)) << engine;
    EXPECT_EQ(to_csv(sensitivity_table(again, true)), to_csv(sensitivity_table(explanation, true)));
    EXPECT_EQ(to_csv(headroom_table(again)), to_csv(headroom_table(explanation)));
    EXPECT_EQ(to_csv(explained_passes(again)), to_csv(explained_passes(explanation)));
  }
}

TEST(AnswersJson, RankingComesBackWithItsTable) {
  const Workbench bench;
  Request request = bench.request({"agaa", "msaa4x"}, {"hd5870"});
  request.settings.reference_samples = 4;
  request.settings.images = true;
  const Ranking ranking = Lab().rank(request, "aa_ms<=1");
  const Ranking again = ranking_from_json(through_text(to_json(ranking)));
  EXPECT_EQ(to_json(again), to_json(ranking));
  EXPECT_EQ(to_csv(ranking_table(again)), to_csv(ranking_table(ranking)));
  EXPECT_FALSE(again.techniques.back().runs());
}

TEST(AnswersJson, SweepSummaryComesBackWithItsPoints) {
  const Workbench bench;
  Lab lab;
  const SweepPlan points = lab.plan_sweep(bench.request({"none", "msaa4x"}),
                                          {parse_axes({"gpu.core_clock_mhz=800,1600"}), Combine::grid});
  const SweepSummary summary =
      lab.sweep(points, {.database = bench.path("sweep.sqlite"), .shard = parse_shard("1/2")});
  const Json json = to_json(summary);
  const SweepSummary again = sweep_summary_from_json(through_text(json));
  EXPECT_EQ(to_json(again), json);
  EXPECT_EQ(to_csv(collected(again.points)), to_csv(collected(summary.points)))
      << "points that are not done have empty cells";
  EXPECT_EQ(collected(again.points).rows.size(), 4u);
  EXPECT_EQ(again.done, 2u);
  EXPECT_EQ(again.left, 2u);
  for (const char* key : {"database", "done", "failed", "left", "points"}) {
    Json cut = json;
    cut.erase(key);
    EXPECT_THROW(sweep_summary_from_json(cut), Json::exception) << key;
  }
}

Errors errors(double mape_pct, std::size_t cells) {
  return {.cells = cells,
          .mape_pct = mape_pct,
          .median_ape_pct = mape_pct / 3.0,
          .worst = CellError{"table:12", "grass, msaa4x on hd5870", 2.0 * mape_pct},
          .kendall = 0.75,
          .coverage90_pct = 87.5};
}

Validation there_and_back(const Validation& validation) {
  Validation again = validation_from_json(through_text(to_json(validation)));
  EXPECT_EQ(to_json(again), to_json(validation));
  EXPECT_EQ(to_csv(split_table(again)), to_csv(split_table(validation)));
  EXPECT_EQ(to_csv(label_table(again)), to_csv(label_table(validation)));
  return again;
}

TEST(AnswersJson, EveryFieldOfAValidationComesBack) {
  const Validation validation{
      .splits = {{"in_sample", errors(1, 10), {{"bytes", errors(2, 9)}, {"mean", errors(3, 8)}}},
                 {"leave_scene_out", errors(4, 7), {{"bytes", errors(5, 6)}, {"mean", {}}}}},
      .papers = {{"AGAA", errors(6, 5)}, {"SSS", {}}},
      .gpus = {{"gtx980", errors(7, 4)}},
      .shaded_samples = {8.5, 3},
      .memory = {9.5, 2},
      .parameters = 21,
      .fitted_values = 22,
      .not_run = {{"table:13", "technique is missing"}}};
  const Json json = to_json(validation);
  const Validation again = there_and_back(validation);
  EXPECT_EQ(again.splits[1].baselines[0].second.cells, 6u);
  EXPECT_FALSE(again.papers[1].second.worst);
  EXPECT_EQ(again.shaded_samples.error_pct, 8.5);
  EXPECT_EQ(again.memory.cells, 2u);
  EXPECT_EQ(again.not_run.front().reason, "technique is missing");
  EXPECT_FALSE(again.model);
  for (const auto& [key, value] : json.items()) {
    if (key == "schema_version") continue;
    Json cut = json;
    cut.erase(key);
    EXPECT_THROW(validation_from_json(cut), Json::exception) << key;
  }
}

TEST(AnswersJson, ValidationOfAPaperComesBackWithItsTables) {
  const ConfigFolder folder;
  Observer silent;
  const std::string kept = read_file(hwsim::test::source_dir() + "/tests/data/published.traces");
  const cost_models::TraceSource traces = cost_models::source_of(
      cost_models::decode_kept({reinterpret_cast<const std::uint8_t*>(kept.data()), kept.size()}));
  const Validation validation = errors_of(std::make_shared<const FittedModel>(fit_and_validate(
      load_experiment(published_cells({"axaa"}, folder), traces, folder, silent), {}, silent)));
  ASSERT_EQ(validation.splits.size(), std::size_t{cost_models::kSplitCount});
  EXPECT_EQ(validation.splits.front().errors.cells, 15u);
  EXPECT_EQ(worst_table(*validation.model, 1).rows.front().size(), 5u);
  there_and_back(validation);
}

}  // namespace
}  // namespace hwsim::lab
