// Techniques under a budget, and why a frame takes its time.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace hwsim::cli::test {
namespace {

using nlohmann::json;

class RankTest : public testing::Test {
 protected:
  RankTest() { place.write("triangle.gltf", kTriangleGltf); }
  json rank(const std::string& flags, int status = 0) {
    const Outcome outcome = place.hwsim(
        "rank triangle.gltf --resolution 96x64 --reference 4 --force --out result --json " + flags);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }
  std::map<std::string, json> by_name(const json& result) {
    std::map<std::string, json> rows;
    for (const json& row : result["techniques"]) rows[row["technique"]] = row;
    return rows;
  }
  Workplace place;
};

TEST_F(RankTest, CostsAreThoseBeyondNoAntiAliasing) {
  const auto rows = by_name(rank("-t msaa4x,msaa8x --no-image"));
  ASSERT_EQ(rows.size(), 3u) << "none is always there";
  const json& none = rows.at("none");
  EXPECT_EQ(none["aa_ms"], 0.0);
  EXPECT_EQ(none["extra_mib"], 0.0);
  for (const char* name : {"msaa4x", "msaa8x"}) {
    const json& row = rows.at(name);
    EXPECT_NEAR(row["aa_ms"].get<double>(), row["frame_ms"].get<double>() - none["frame_ms"].get<double>(),
                1e-12);
    EXPECT_GT(row["extra_mib"].get<double>(), 0.0);
    EXPECT_EQ(row["verdict"], "ok") << "no budget, no objection";
  }
}

TEST_F(RankTest, FrontHoldsExactlyWhatNobodyBeats) {
  const json result = rank("-t none,msaa2x,msaa4x,msaa8x,ssaa4x --no-image");
  for (const json& a : result["techniques"]) {
    bool beaten = false;
    for (const json& b : result["techniques"]) {
      const double time = b["frame_ms"].get<double>() - a["frame_ms"].get<double>();
      const double error = b["flip_mean"].get<double>() - a["flip_mean"].get<double>();
      beaten = beaten || (time <= 0 && error <= 0 && (time < 0 || error < 0));
    }
    EXPECT_EQ(a["pareto"] == "yes", !beaten) << a["technique"];
  }
}

TEST_F(RankTest, VerdictsFollowTheBudget) {
  const json result = rank("-t msaa4x,msaa8x --no-image --set gpu.features.native_msaa_max=4");
  const auto rows = by_name(result);
  EXPECT_EQ(rows.at("msaa8x")["verdict"], "unsupported");
  EXPECT_NE(rows.at("msaa8x")["reason"].get<std::string>().find("native_msaa_max"), std::string::npos);
  const double mib = rows.at("msaa4x")["extra_mib"], ms = rows.at("msaa4x")["aa_ms"];
  const auto verdict = [&](double limit_ms, double limit_mib, int status) {
    return by_name(rank("-t msaa4x --no-image --budget 'aa_ms <= " + std::to_string(limit_ms) +
                            ", extra_mib<=" + std::to_string(limit_mib) + "'",
                        status))
        .at("msaa4x")["verdict"]
        .get<std::string>();
  };
  EXPECT_EQ(verdict(ms + 1, mib + 1, 0), "ok");
  EXPECT_EQ(verdict(ms + 1, mib - 0.01, 0), "over memory") << "`none` is within";
  EXPECT_EQ(verdict(0.5 * ms, mib + 1, 0), "over time") << "`none` is within";
  EXPECT_EQ(rank("-t msaa4x --no-image --budget 'frame_ms<=0'", 4)["techniques"].size(), 2u);
}

TEST_F(RankTest, SheetShowsTheWorstRegions) {
  const json result = rank("-t msaa4x");
  EXPECT_EQ(place.listing("result"),
            "contact_sheet.png log.txt manifest.json msaa4x@gtx980 none@gtx980 ranking.csv ranking.json");
  ASSERT_GE(result["regions"].size(), 1u);
  for (size_t i = 0; i < result["regions"].size(); ++i) {
    const json& a = result["regions"][i];
    EXPECT_GE(a["x_px"].get<int>(), 0);
    EXPECT_LE(a["x_px"].get<int>() + a["side_px"].get<int>(), 96);
    EXPECT_LE(a["y_px"].get<int>() + a["side_px"].get<int>(), 64);
    for (size_t k = 0; k < i; ++k) {
      const json& b = result["regions"][k];
      const int side = a["side_px"];
      EXPECT_TRUE(std::abs(a["x_px"].get<int>() - b["x_px"].get<int>()) >= side ||
                  std::abs(a["y_px"].get<int>() - b["y_px"].get<int>()) >= side);
    }
  }
}

// Two GPUs in two views: what each ranking says is what a run for it alone says, and each image is drawn
// once.
TEST_F(RankTest, SeveralGpusAndViewsAreARankingEach) {
  const Outcome outcome = place.hwsim(
      "rank triangle.gltf -t msaa4x -g gtx980,rtx4090 --vary resolution=96x64,48x32 --reference 4 --force "
      "--out "
      "result --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json all = json::parse(outcome.out);
  ASSERT_EQ(all["rankings"].size(), 4u);
  EXPECT_EQ(all["rankings"][1]["gpu"], "rtx4090");
  EXPECT_EQ(all["rankings"][2]["resolution"], json({48, 32}));
  EXPECT_EQ(all["overall"].size(), 2u);
  EXPECT_EQ(all["overall"][0]["technique"], "msaa4x") << "the closer one";
  EXPECT_EQ(place.listing("result").substr(0, 7), "log.txt");
  EXPECT_NE(place.listing("result").find("resolution-48x32-contact_sheet.png"), std::string::npos)
      << place.listing("result");
  EXPECT_NE(place.listing("result").find("resolution-48x32-msaa4x@rtx4090"), std::string::npos);
  const json alone = rank("-t msaa4x -g rtx4090 --no-image");
  EXPECT_EQ(all["rankings"][1]["techniques"], alone["techniques"]);
}

TEST_F(RankTest, GpuWithoutAnIntervalIsUnknownUnderABudgetOfTime) {
  const auto rows = by_name(rank("-t msaa4x -g rtx4090 --no-image --budget 'frame_ms<=1000'"));
  EXPECT_EQ(rows.at("msaa4x")["verdict"], "unknown");
  EXPECT_EQ(by_name(rank("-t msaa4x -g gtx980 --no-image --budget 'frame_ms<=1000'")).at("msaa4x")["verdict"],
            "ok");
}

TEST_F(RankTest, MetricAndEdgesOrderTechniques) {
  for (const std::string metric : {"flip", "psnr", "ssim"}) {
    const json result = rank("-t none,msaa2x,msaa8x --no-image --metric " + metric);
    const std::string column = metric == "flip" ? "flip_mean" : metric == "psnr" ? "psnr_db" : "ssim";
    const double sign = metric == "flip" ? 1.0 : -1.0;
    for (std::size_t i = 1; i < result["techniques"].size(); ++i)
      EXPECT_GE(sign * result["techniques"][i][column].get<double>(),
                sign * result["techniques"][i - 1][column].get<double>())
          << metric;
  }
  const auto rows = by_name(rank("-t msaa4x --no-image --edges --metric psnr"));
  const json& none = rows.at("none");
  EXPECT_LT(none["edge_psnr_db"].get<double>(), none["psnr_db"].get<double>())
      << "the triangle errs at its edges";
  EXPECT_GT(none["edge_flip_mean"].get<double>(), none["flip_mean"].get<double>());
}

TEST_F(RankTest, MistakesEndInMessages) {
  const auto refused = [&](const std::string& arguments, const std::string& code) {
    const Outcome outcome = place.hwsim("rank triangle.gltf " + arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_NE(outcome.err.find("error[" + code + "]"), std::string::npos) << arguments << outcome.err;
  };
  for (const char* budget : {"'aa_ms<1'", "'aa_ms<=x'", "'am_ms<=1'", "'aa_ms<=1,'", "'<=1'", "'aa_ms<=nan'"})
    refused("--budget " + std::string(budget), "U022");
  refused("--vary gpu.core_clock_mhz=1,2", "U019");
  refused("--metric psrn", "U003");
  refused("--metric ssim --edges", "U003");
  // The last view's mistake comes before the first one's frames.
  const Outcome late = place.hwsim("rank triangle.gltf -t fxaa --resolution 32x32 --vary camera=0,7");
  EXPECT_NE(late.err.find("error[U009]"), std::string::npos) << late.err;
  EXPECT_EQ(late.err.find("none on"), std::string::npos) << late.err;
  EXPECT_EQ(place.listing(), "triangle.gltf");
}

class ExplainTest : public RankTest {
 protected:
  json explain(const std::string& flags) {
    const Outcome outcome = place.hwsim("explain triangle.gltf --resolution 96x64 --json " + flags);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }
};

TEST_F(ExplainTest, StackSumsToTheTimeAndHeadroomIsNoLoss) {
  const json result = explain("-t msaa4x");
  for (const json& pass : result["passes"]) {
    double sum_ms = 0.0;
    for (const auto& [unit, ms] : pass["stack_ms"].items()) sum_ms += ms.get<double>();
    EXPECT_NEAR(sum_ms, pass["time_ms"].get<double>(), 1e-9) << pass["name"];
  }
  ASSERT_FALSE(result["headroom"].empty());
  for (const auto& [unit, headroom] : result["headroom"].items())
    EXPECT_LE(headroom["time_ms"].get<double>(), result["frame"]["time_ms"].get<double>() * (1 + 1e-12))
        << unit;
}

// The derivative predicts what a small change does, measured by a run.
TEST_F(ExplainTest, ElasticityPredictsASmallChange) {
  const json result = explain("-t msaa4x");
  const double before_ms = result["frame"]["time_ms"];
  for (const json& s : result["sensitivity"]) {
    const std::string path = s["parameter"];
    if (path != "gpu.pass_overhead_us" && path != "gpu.core_clock_mhz") continue;
    const Outcome run = place.hwsim(
        "run triangle.gltf --resolution 96x64 -t msaa4x --no-image --json --set " + path + "=x1.01");
    const double after_ms = json::parse(run.out)["frame"]["time_ms"];
    const double predicted = 0.01 * s["elasticity"].get<double>();
    EXPECT_NEAR((after_ms - before_ms) / before_ms, predicted, 0.02 * std::abs(predicted) + 1e-6) << path;
  }
}

TEST_F(ExplainTest, TwoTechniquesShowWhereTheyDiffer) {
  const json result = explain("-t none,msaa4x");
  EXPECT_EQ(result["results"].size(), 2u);
  ASSERT_EQ(result["difference"].size(), 1u);
  EXPECT_EQ(result["difference"][0]["technique"], "msaa4x");
  const Outcome text = place.hwsim("explain triangle.gltf --resolution 96x64 -t none,msaa4x");
  EXPECT_NE(text.out.find("holds the frame back most"), std::string::npos) << text.out;
}

}  // namespace
}  // namespace hwsim::cli::test
