// Many points in a database: every one there once, whatever interrupts.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/program.h"

namespace hwsim::cli::test {
namespace {

using nlohmann::json;

class SweepTest : public testing::Test {
 protected:
  SweepTest() { place.write("triangle.gltf", kTriangleGltf); }
  Outcome sweep(const std::string& flags) {
    return place.hwsim("sweep triangle.gltf --resolution 64x48 " + flags);
  }
  json points(const std::string& flags) {
    const Outcome outcome = sweep("--json " + flags);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }
  Workplace place;
};

TEST_F(SweepTest, GridHasEveryCombinationOnceWithTheTimesOfRun) {
  const json rows = points("-t none,msaa4x -g gtx980 -g gtx470 --vary gpu.core_clock_mhz=500,1000,1500");
  ASSERT_EQ(rows.size(), 12u);
  std::set<std::string> ids;
  for (const json& row : rows) {
    ids.insert(row["point_id"]);
    EXPECT_EQ(row["state"], "done");
  }
  EXPECT_EQ(ids.size(), 12u);
  const json& row = rows[6];  // settings vary slowest, then techniques, then GPUs
  EXPECT_EQ(row["technique"], "msaa4x");
  EXPECT_EQ(row["gpu"], "gtx980");
  EXPECT_EQ(row["gpu.core_clock_mhz"], "1000");
  const Outcome run = place.hwsim(
      "run triangle.gltf --resolution 64x48 --no-image --json -t msaa4x --set gpu.core_clock_mhz=1000");
  EXPECT_EQ(json::parse(run.out)["frame"]["time_ms"], row["time_ms"]);
}

TEST_F(SweepTest, LatinHypercubeUsesEachStratumOnceAndRepeats) {
  const std::string flags =
      "--vary gpu.core_clock_mhz=1000..2000 --vary gpu.dram_bandwidth_gb_s=100..1600 --sample lhs:20 ";
  const json first = points(flags + "--db a.sqlite"), again = points(flags + "--db b.sqlite");
  EXPECT_EQ(first, again);
  EXPECT_NE(first, points(flags + "--seed 2 --db c.sqlite"));
  for (const auto& [key, low, width] :
       {std::tuple{"gpu.core_clock_mhz", 1000.0, 50.0}, std::tuple{"gpu.dram_bandwidth_gb_s", 100.0, 75.0}}) {
    std::set<int> strata;
    for (const json& row : first)
      strata.insert(static_cast<int>((std::stod(row[key].get<std::string>()) - low) / width));
    EXPECT_EQ(strata.size(), 20u) << key;
    EXPECT_EQ(*strata.begin(), 0);
    EXPECT_EQ(*strata.rbegin(), 19);
  }
}

// Words vary what flags say: the points are those of `run` with the flags.
TEST_F(SweepTest, WordsVaryWhatFlagsSay) {
  const Outcome outcome = place.hwsim(
      "sweep -t msaa4x --vary scene=triangle.gltf,grass:blades=10 --vary resolution=64x48,32x32 --vary "
      "gpu=gtx980,gtx470 --vary overlay=none,dram-x2+l2-x4 --reference 4 --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json rows = json::parse(outcome.out);
  ASSERT_EQ(rows.size(), 16u);
  const json& row = rows[15];
  EXPECT_EQ(row["scene"], "grass:blades=10");
  EXPECT_EQ(row["width_px"], 32u);
  EXPECT_EQ(row["gpu"], "gtx470");
  const Outcome run = place.hwsim(
      "run grass:blades=10 --resolution 32x32 -g gtx470 --overlay dram-x2 --overlay l2-x4 -t msaa4x "
      "--reference 4 "
      "--no-image --json");
  const json result = json::parse(run.out);
  EXPECT_EQ(row["time_ms"], result["frame"]["time_ms"]);
  EXPECT_EQ(row["flip_mean"], result["image"]["flip_mean"]);
  EXPECT_EQ(row["psnr_db"], result["image"]["psnr_db"]);
  EXPECT_EQ(row["ssim"], result["image"]["ssim"]);
  EXPECT_NE(rows[0]["time_ms"], row["time_ms"]);
  EXPECT_EQ(
      json::parse(sweep("--vary gpu.l2_size_kib=512 --db plain.sqlite --json").out)[0].count("flip_mean"), 0u)
      << "no error was asked for";
}

TEST_F(SweepTest, SharesItsPointsWithNobodyWhoAskedForNoErrors) {
  ASSERT_EQ(sweep("--db a.sqlite").status, 0);
  const json rows = points("--db a.sqlite --resume --reference 4");
  ASSERT_EQ(rows.size(), 2u) << "a point without an error stays what it is";
  EXPECT_NE(rows[0]["flip_mean"].is_null(), rows[1]["flip_mean"].is_null())
      << "their order is that of their digests";
}

TEST_F(SweepTest, ShowsWhatPointsSayTogetherAndRowsOnRequest) {
  const Outcome found = sweep("-t none,msaa4x --vary gpu.core_clock_mhz=500..2000:40 --reference 4");
  ASSERT_EQ(found.status, 0) << found.err;
  for (const char* part : {"80 points done, 0 failed, 0 left: ", "The fastest", "What mattered",
                           "gpu.core_clock_mhz", "Nobody is faster and closer to the reference"})
    EXPECT_NE(found.out.find(part), std::string::npos) << part << found.out;
  const auto lines = [](const std::string& text) { return std::ranges::count(text, '\n'); };
  EXPECT_LT(lines(found.out), 30);
  EXPECT_EQ(lines(place.hwsim("sweep --rows").out), 82) << "a title, a rule, and every point";
  EXPECT_EQ(lines(place.hwsim("sweep --format csv").out), 81);
}

TEST_F(SweepTest, KilledAndResumedItEqualsAnUninterruptedOne) {
  const std::string flags = "-t none,msaa4x --vary gpu.core_clock_mhz=500..2000:300 --format csv ";
  const Outcome whole = sweep(flags + "--db whole.sqlite");
  ASSERT_EQ(whole.status, 0) << whole.err;
  // Killed without warning, several times, at other places each time.
  for (const char* delay : {"0.12", "0.25", "0.4"})
    place.shell("hwsim sweep triangle.gltf --resolution 64x48 " + flags +
                "--resume --db cut.sqlite >/dev/null 2>&1 & sleep " + delay + "; kill -KILL $!; wait $!");
  const Outcome resumed = sweep(flags + "--resume --db cut.sqlite");
  ASSERT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_EQ(resumed.out, whole.out);
  EXPECT_NE(resumed.err.find("600 points done, 0 failed, 0 left"), std::string::npos) << resumed.err;
}

TEST_F(SweepTest, ShardsMergeToTheWhole) {
  const std::string flags = "--vary gpu.core_clock_mhz=500..1500:7 --format csv ";
  const Outcome whole = sweep(flags + "--db whole.sqlite");
  for (const std::string shard : {"1", "2", "3"})
    ASSERT_EQ(sweep(flags + "--shard " + shard + "/3 --db part" + shard + ".sqlite").status, 0);
  const Outcome merged = place.hwsim(
      "sweep --format csv --db all.sqlite --merge part1.sqlite --merge part2.sqlite --merge part3.sqlite");
  ASSERT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(merged.out, whole.out);
}

// A plan says what there is to do; shards of the work do it; points find it done, wherever they run.
TEST_F(SweepTest, EmulationsComeFirstInShardsOfEqualWork) {
  const std::string axes =
      "-t none,msaa4x,ssaa4x --vary resolution=64x48,320x200,640x400 --vary gpu.l2_size_kib=512,1024 ";
  const auto sweep = [&](const std::string& flags) {
    return place.hwsim("sweep triangle.gltf --resolution 64x48 " + flags, "HWSIM_CACHE=cache ");
  };
  ASSERT_EQ(sweep(axes + "--plan plan.json --shard 1/2").status, 0);
  const json plan = json::parse(place.read("plan.json"));
  ASSERT_EQ(plan["works"].size(), 9u) << "L2 changes no work";
  ASSERT_EQ(plan["points"].size(), 18u);
  std::map<int, double> seconds;
  double largest = 0.0;
  for (const json& work : plan["works"]) {
    EXPECT_EQ(work["points"], 2u);
    EXPECT_EQ(work["kept"], "no");
    seconds[work["shard"].get<int>()] += work["expected_s"].get<double>();
    largest = std::max(largest, work["expected_s"].get<double>());
  }
  ASSERT_EQ(seconds.size(), 2u);
  EXPECT_LE(std::abs(seconds[1] - seconds[2]), largest);
  EXPECT_EQ(sweep(axes + "--plan plan.json").status, 3) << "it is there already";

  const Outcome first = sweep(axes + "--emulate-only --shard 1/2"),
                second = sweep(axes + "--emulate-only --shard 2/2");
  ASSERT_EQ(first.status + second.status, 0) << first.err << second.err;
  EXPECT_NE(sweep(axes + "--emulate-only").err.find(" 9 kept, 0 failed"), std::string::npos);
  EXPECT_EQ(place.listing(), "cache plan.json triangle.gltf") << "no database";
  EXPECT_EQ(sweep(axes + "--plan again.json").status, 0);
  const json again = json::parse(place.read("again.json"));
  ASSERT_FALSE(again["works"].empty());
  for (const json& work : again["works"]) EXPECT_EQ(work["kept"], "yes");
  EXPECT_EQ(place.hwsim("sweep --emulate-only").status, 2);
  EXPECT_EQ(sweep("--emulate-only --no-cache").status, 2);
}

TEST_F(SweepTest, FailedPointsAreKeptWithTheirReasonAndEndIn5) {
  const Outcome outcome = sweep("-t none,msaa8x --vary gpu.features.native_msaa_max=4,8 --json");
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  const json rows = json::parse(outcome.out);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[1]["state"], "failed");
  EXPECT_NE(rows[1]["message"].get<std::string>().find("native_msaa_max"), std::string::npos) << rows[1];
  for (const size_t i : {0u, 2u, 3u}) EXPECT_EQ(rows[i]["state"], "done");
}

TEST_F(SweepTest, DryRunListsPointsAndWritesNothing) {
  const Outcome outcome = sweep("--vary gpu.core_clock_mhz=1,2,3 --dry-run --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out).size(), 3u);
  EXPECT_EQ(place.listing(), "triangle.gltf");
}

TEST_F(SweepTest, ExistingSweepIsKeptUnlessForcedOrResumed) {
  ASSERT_EQ(sweep("").status, 0);
  const Outcome refused = sweep("");
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find("error[U013]"), std::string::npos) << refused.err;
  EXPECT_EQ(sweep("--resume").status, 0);
  EXPECT_EQ(points("--force -t none,msaa4x").size(), 2u);
  EXPECT_EQ(json::parse(place.hwsim("sweep --json").out).size(), 2u);
}

// A database that carries no mark of hwsim may be anybody's.
TEST_F(SweepTest, DatabaseOfAnotherProgramStaysAsItWas) {
  ASSERT_EQ(sweep("--db ours.sqlite").status, 0);
  std::string foreign = place.read("ours.sqlite");
  ASSERT_EQ(foreign.rfind("SQLite format 3", 0), 0u);
  constexpr std::size_t kApplicationIdAt = 68;
  foreign.replace(kApplicationIdAt, 4, std::string(4, '\0'));
  place.write("notes.sqlite", foreign);
  const std::string listing = place.listing();
  for (const std::string arguments :
       {"sweep --db notes.sqlite", "sweep triangle.gltf --db notes.sqlite --force",
        "sweep triangle.gltf --db notes.sqlite --resume", "sweep --db notes.sqlite --merge ours.sqlite",
        "sweep --db ours.sqlite --merge notes.sqlite"}) {
    const Outcome outcome = place.hwsim(arguments);
    EXPECT_EQ(outcome.status, 3) << arguments;
    EXPECT_NE(outcome.err.find("error[U021]"), std::string::npos) << arguments << outcome.err;
    EXPECT_NE(outcome.err.find("= help:"), std::string::npos) << arguments << outcome.err;
    EXPECT_EQ(place.read("notes.sqlite"), foreign) << arguments;
    EXPECT_EQ(place.listing(), listing) << arguments;
  }
}

TEST_F(SweepTest, MistakesEndInMessages) {
  const auto refused = [&](const std::string& arguments, int status, const std::string& code) {
    const Outcome outcome = place.hwsim("sweep " + arguments);
    EXPECT_EQ(outcome.status, status) << arguments;
    EXPECT_NE(outcome.err.find("error[" + code + "]"), std::string::npos) << arguments << outcome.err;
    EXPECT_EQ(outcome.err.find("X001"), std::string::npos) << outcome.err;
  };
  place.write("thesis.sqlite", std::string(4096, 'x'));
  refused("", 2, "U002");
  refused("triangle.gltf --sample lhs:0 --vary gpu.core_clock_mhz=1..2", 2, "U019");
  refused("triangle.gltf --sample sobol:4 --vary gpu.core_clock_mhz=1..2", 2, "U019");
  refused("triangle.gltf --shard 4/3", 2, "U003");
  refused("triangle.gltf --vary resoltion=1x1", 3, "C020");
  refused("triangle.gltf --vary resolution=1", 3, "U005");
  refused("triangle.gltf --vary gpu=gtx980,gtx999", 3, "C016");
  refused("triangle.gltf --vary overlay=dram-x3", 3, "U018");
  refused("triangle.gltf --vary camera=0,7", 3, "U009");
  refused("--vary scene=triangle.gltf,none.gltf", 3, "S001");
  refused("triangle.gltf --vary gpu.core_clock_mhz=1000,-1", 3, "C014");
  refused("triangle.gltf --db thesis.sqlite", 3, "U013");
  refused("triangle.gltf --db thesis.sqlite --resume", 3, "U021");
  refused("triangle.gltf --db thesis.sqlite --force", 3, "U021");
  refused("triangle.gltf --db missing/a.sqlite", 3, "U021");
  refused("--merge missing.sqlite", 3, "U021");
  EXPECT_EQ(place.read("thesis.sqlite"), std::string(4096, 'x'));
}

}  // namespace
}  // namespace hwsim::cli::test
