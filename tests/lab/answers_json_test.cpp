// What the lab answers is the same after JSON: nothing is lost, and what is unknown is ignored.
#include <gtest/gtest.h>

#include "lab/lab.h"
#include "lab/workbench.h"

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

}  // namespace
}  // namespace hwsim::lab
