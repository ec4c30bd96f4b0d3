// What a run prints and leaves behind.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "cli/program.h"

namespace hwsim::cli::test {
namespace {

using nlohmann::json;

constexpr const char* kSmall = "run triangle.gltf --resolution 64x48 ";

class RunTest : public testing::Test {
 protected:
  RunTest() { place.write("triangle.gltf", kTriangleGltf); }
  Outcome run(const std::string& flags, const std::string& environment = "") {
    return place.hwsim(kSmall + flags, environment);
  }
  Workplace place;
};

void expect_keys(const json& object, std::initializer_list<const char*> keys) {
  for (const char* key : keys) EXPECT_TRUE(object.contains(key)) << key;
}

TEST_F(RunTest, ImageFilesAreFiltered) {
  ASSERT_EQ(run("-t none --out drawn").status, 0);
  const Outcome drawn = run("-t fxaa --out both"),
                filtered = place.hwsim("run drawn/color.png -t fxaa --json --out filtered");
  ASSERT_EQ(filtered.status, 0) << filtered.err;
  const json result = json::parse(filtered.out);
  EXPECT_EQ(result["resolution"], json({64, 48}));
  EXPECT_EQ(result["technique"], "fxaa");
  EXPECT_EQ(result["passes"].size(), 2u);
  EXPECT_EQ(place.read("filtered/color.png"), place.read("both/color.png"));
}

TEST_F(RunTest, TheReferenceHasTheFramesShadowMapUnlessRaysAreAskedFor) {
  const auto psnr_db = [&](const std::string& flags) {
    const Outcome outcome = place.hwsim(
        "run sponza_hall:bays=3,detail=4 --resolution 96x54 -t ssaa16x --json --reference 16 --force "
        "--out result " +
        flags);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out)["image"]["psnr_db"].get<double>();
  };
  const double by_map = psnr_db(""), by_rays = psnr_db("--reference-shadows rays");
  EXPECT_GT(by_map, by_rays + 2.0);
  EXPECT_EQ(psnr_db("--set scene.reference_shadows=map"), by_map);
  const Outcome wrong = run("-t none --reference 1 --reference-shadows both --out wrong");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("U003"), std::string::npos) << wrong.err;
}

TEST_F(RunTest, SettingsReachThePartThatHasTheParameter) {
  const Outcome outcome =
      run("-t msaa4x+fxaa:subpix=0.5 --set technique.preset=39 --set technique.centroid=off --json --out r");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)["technique"], "msaa4x:centroid=off+fxaa:preset=39,subpix=0.5");
}

TEST_F(RunTest, JsonHasTheKeysOfTheContract) {
  const Outcome outcome = run("-t msaa4x --json --reference 1 --out result");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json result = json::parse(outcome.out);
  expect_keys(result, {"schema_version", "scene", "technique", "gpu", "engine", "resolution", "frame",
                       "passes", "image", "emulation", "timing"});
  EXPECT_EQ(result["technique"], "msaa4x");
  EXPECT_EQ(result["gpu"], "gtx980");
  EXPECT_EQ(result["engine"], "queue");
  EXPECT_EQ(result["resolution"], json({64, 48}));
  expect_keys(result["frame"], {"time_ms", "interval_ms", "support", "error_sources", "memory_mib",
                                "allocated_mib", "dram_mb", "shaded_samples"});
  EXPECT_GT(result["frame"]["time_ms"], 0.0);
  expect_keys(result["image"], {"psnr_db", "flip_mean", "rmse"});
  expect_keys(result["emulation"], {"wall_s", "from_cache", "skipped"});
  expect_keys(result["timing"], {"wall_s"});
  ASSERT_FALSE(result["passes"].empty());
  double sum_ms = 0.0;
  for (const json& pass : result["passes"]) {
    expect_keys(pass, {"name", "kind", "time_ms", "limiter", "units", "bytes", "counters"});
    expect_keys(pass["units"], {"fe", "shader", "dram"});
    expect_keys(pass["bytes"], {"depth", "color", "texture", "storage"});
    expect_keys(pass["counters"], {"raster.fragments", "ps.invocations"});
    sum_ms += pass["time_ms"].get<double>();
  }
  EXPECT_NEAR(sum_ms, result["frame"]["time_ms"].get<double>(), 1e-9 * sum_ms);
  EXPECT_EQ(json::parse(place.read("result/result.json")), result);
}

TEST_F(RunTest, WritesTheFilesOfARunDirectory) {
  const Outcome outcome = run("-t none --reference 1 --out result");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(
      place.listing("result"),
      "color.exr color.png counters.csv flip.exr flip.png gpu.toml heat_shading.png log.txt manifest.json "
      "passes.csv reference.exr reference.png result.json run.toml trace.json");
  EXPECT_EQ(place.listing(), "result triangle.gltf") << "something partial was left";
  const json manifest = json::parse(place.read("result/manifest.json"));
  expect_keys(manifest, {"version", "model_version", "commit", "compiler", "host", "argv", "overrides",
                         "seed", "input_hashes", "wall_s", "fragments_per_s", "reused_passes", "state"});
  EXPECT_EQ(manifest["state"], "done");
}

TEST_F(RunTest, NoImageWritesNumbersOnly) {
  ASSERT_EQ(run("--no-image --out result").status, 0);
  EXPECT_EQ(place.listing("result"),
            "counters.csv gpu.toml log.txt manifest.json passes.csv result.json run.toml trace.json");
}

TEST_F(RunTest, DefaultFolderIsLinkedAsLatest) {
  ASSERT_EQ(run("--no-image").status, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(place / "runs/latest"));
  EXPECT_TRUE(std::filesystem::exists(place / "runs/latest/result.json"));
}

TEST_F(RunTest, RunFileGivesTheSameNumbers) {
  ASSERT_EQ(run("-t msaa4x --set gpu.core_clock_mhz=987 --lights 3 --no-image --out first").status, 0);
  const Outcome again = place.hwsim("run first/run.toml --no-image --out second");
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(place.read("first/passes.csv"), place.read("second/passes.csv"));
  EXPECT_EQ(place.read("first/run.toml"), place.read("second/run.toml"));
  EXPECT_EQ(place.read("first/gpu.toml").find("987") == std::string::npos, false);
}

TEST_F(RunTest, NumberOfThreadsChangesNoByte) {
  ASSERT_EQ(run("-t msaa4x --jobs 1 --no-cache --out one").status, 0);
  ASSERT_EQ(run("-t msaa4x --jobs 3 --no-cache --out three").status, 0);
  for (const char* file : {"/passes.csv", "/counters.csv", "/color.png", "/color.exr", "/trace.json"})
    EXPECT_TRUE(place.read(std::string("one") + file) == place.read(std::string("three") + file)) << file;
}

TEST_F(RunTest, TraceHasSlicesAndCountersOnly) {
  ASSERT_EQ(run("--no-image --out result").status, 0);
  const json trace = json::parse(place.read("result/trace.json"));
  size_t slices = 0, counters = 0;
  for (const json& event : trace["traceEvents"]) {
    const std::string phase = event["ph"];
    EXPECT_TRUE(phase == "X" || phase == "C" || phase == "M") << phase;
    slices += phase == "X";
    counters += phase == "C";
  }
  EXPECT_GT(slices, 1u);
  EXPECT_GT(counters, 1u);
}

// Units begin when the queue gives them their first work, and not all at the begin of their pass.
TEST_F(RunTest, TraceHasTheScheduleOfTheQueue) {
  ASSERT_EQ(run("--no-image --out result").status, 0);
  const json trace = json::parse(place.read("result/trace.json"));
  std::map<std::string, std::pair<double, double>> passes;
  std::size_t later = 0, slices = 0;
  for (const json& event : trace["traceEvents"]) {
    if (event["ph"] != "X") continue;
    const double begin = event["ts"], end = begin + event["dur"].get<double>();
    if (event["tid"] == 0) {
      passes[event["name"]] = {begin, end};
      continue;
    }
    const auto [first, last] = passes.at(event["name"]);
    EXPECT_GE(begin, first * (1.0 - 1e-12)) << event;
    EXPECT_LE(end, last * (1.0 + 1e-12)) << event;
    later += begin > first;
    ++slices;
  }
  EXPECT_GT(later, slices / 2) << "what comes behind another unit begins later";
}

TEST_F(RunTest, CsvHasOneHeaderAndRecordsOfItsLength) {
  const Outcome outcome = run("--format csv --no-image --out result");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  size_t lines = 0, commas = 0;
  for (size_t at = 0, end; at < outcome.out.size(); at = end + 2, ++lines) {
    end = outcome.out.find("\r\n", at);
    ASSERT_NE(end, std::string::npos) << "a line does not end in CRLF";
    const std::string line = outcome.out.substr(at, end - at);
    const auto count = static_cast<size_t>(std::count(line.begin(), line.end(), ','));
    if (lines == 0) commas = count;
    EXPECT_EQ(count, commas) << line;
  }
  EXPECT_GT(lines, 1u);
}

TEST_F(RunTest, HeadlineSaysHowSureItIs) {
  const Outcome outcome = run("--no-image --out result -g gtx980");
  EXPECT_NE(outcome.out.find(" ms ["), std::string::npos) << outcome.out;
  const Outcome documented = run("--no-image --out documented -g gtx980 --set timing.calibrated=false");
  EXPECT_NE(documented.out.find(" ms uncalibrated"), std::string::npos) << documented.out;
}

TEST_F(RunTest, SeveralTechniquesGiveOneSummary) {
  const Outcome outcome = run("-t none,msaa4x -g gtx980 -g gtx470 --json --no-image --out result");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json results = json::parse(outcome.out)["results"];
  ASSERT_EQ(results.size(), 4u);
  EXPECT_EQ(results[2]["technique"], "msaa4x");
  EXPECT_EQ(results[2]["gpu"], "gtx980");
  EXPECT_EQ(place.listing("result"),
            "log.txt manifest.json msaa4x@gtx470 msaa4x@gtx980 none@gtx470 none@gtx980 summary.csv");
}

TEST_F(RunTest, SaysThatThreeAggregatesTakeTheMemoryOfFour) {
  const Outcome padded = run("-t agaa:c=3 --no-image --out padded"),
                dense = run("-t agaa:c=3,accumulate=atomics --no-image --out dense"),
                even = run("-t agaa:c=4 --no-image --out even");
  EXPECT_EQ(padded.status, 0) << padded.err;
  EXPECT_NE(
      padded.err.find("note[T102]: agaa:c=3: color samples divide raster samples: 3 aggregates take the "
                      "memory of 4"),
      std::string::npos)
      << padded.err;
  for (const Outcome& quiet : {dense, even})
    EXPECT_EQ(quiet.err.find("T102"), std::string::npos) << quiet.err;
}

TEST_F(RunTest, SaysWhatAGBufferHasNoRoomFor) {
  std::string gltf = kTriangleGltf;
  const std::string mesh = R"("attributes": {"POSITION": 0})";
  gltf.replace(gltf.find(mesh), mesh.size(), mesh + R"(, "material": 0)");
  gltf.replace(gltf.find("\"meshes\""), 0,
               R"("materials": [{"name": "lamp", "emissiveFactor": [0, 1, 0]}], )");
  place.write("lamp.gltf", gltf);
  const auto told = [&](const std::string& technique) {
    return place.hwsim("run lamp.gltf --resolution 64x48 --no-image --force --json --out lamp -t " +
                       technique);
  };
  // The second answer comes from the cache, without the scene.
  for (int time = 0; time < 2; ++time) {
    const Outcome gray = told("deferred");
    EXPECT_EQ(gray.status, 0) << gray.err;
    EXPECT_NE(gray.err.find("note[T103]: deferred: material `lamp`: colored emission is shown in gray"),
              std::string::npos)
        << gray.err;
    EXPECT_NE(json::parse(gray.out)["warnings"].dump().find("colored emission"), std::string::npos);
  }
  EXPECT_EQ(told("deferred:layout=gb_sbaa40").err.find("T103"), std::string::npos);
}

// The frame below is that of msaa8x; what selective supersampling lights beyond it counts like any other
// light.
TEST_F(RunTest, FurtherSamplesCountAsShaded) {
  const Outcome outcome = place.hwsim(
      "run grill -t msaa8x,sss_cs:mode=or --resolution 96x54 --no-shadows --json --no-image --out grill");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json results = json::parse(outcome.out)["results"];
  std::uint64_t further = 0;
  for (const json& pass : results[1]["passes"])
    further += pass["counters"].value("technique.sss_shaded_samples", std::uint64_t{0});
  EXPECT_GT(further, 0u);
  EXPECT_EQ(results[1]["frame"]["shaded_samples"].get<std::uint64_t>(),
            results[0]["frame"]["shaded_samples"].get<std::uint64_t>() + further);
}

TEST_F(RunTest, FasterMemoryIsNeverSlower) {
  const auto time_ms = [&](const std::string& bandwidth) {
    const Outcome outcome = run("-t msaa4x --json --no-image --set gpu.dram_bandwidth_gb_s=" + bandwidth +
                                " --out bw" + bandwidth);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out)["frame"]["time_ms"].get<double>();
  };
  EXPECT_LE(time_ms("400"), time_ms("20"));
}

TEST_F(RunTest, ResultsAreNotOverwrittenUnasked) {
  ASSERT_EQ(run("--no-image --out result").status, 0);
  const std::string before = place.read("result/manifest.json");
  const Outcome refused = run("--no-image --out result");
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find("error[U013]"), std::string::npos) << refused.err;
  EXPECT_EQ(place.read("result/manifest.json"), before);
  EXPECT_EQ(run("--no-image --out result --force").status, 0);
  EXPECT_NE(place.read("result/manifest.json"), before);
}

TEST_F(RunTest, ForceReplacesNoFolderOfSomebodyElse) {
  std::filesystem::create_directory(place / "thesis");
  place.write("thesis/chapter.txt", "precious");
  const Outcome outcome = run("--no-image --out thesis --force");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_EQ(place.read("thesis/chapter.txt"), "precious");
}

TEST_F(RunTest, InterruptLeavesNothingAndEndsWith130) {
  const Outcome outcome = place.shell(
      "hwsim run triangle.gltf -t ssaa16x,ssaa16x,ssaa16x --resolution 2048x2048 --reference 64 --out result "
      "& "
      "sleep 0.7; kill -INT $!; wait $!");
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_EQ(place.listing(), "triangle.gltf");
}

TEST_F(RunTest, StandardErrorIsPlainWithoutATerminal) {
  const Outcome plain = run("--no-image --out a");
  EXPECT_EQ(plain.err.find('\033'), std::string::npos);
  EXPECT_EQ(plain.err.find('\r'), std::string::npos);
  EXPECT_NE(plain.err.find("100 %"), std::string::npos) << plain.err;
  EXPECT_EQ(run("--no-image --quiet --out b").err, "");
}

TEST(Color, IsAskedForRefusedAndForced) {
  const Workplace place;
  EXPECT_EQ(place.hwsim("run nothing.gltf", "NO_COLOR=1").err.find('\033'), std::string::npos);
  EXPECT_NE(place.hwsim("run nothing.gltf --color always", "NO_COLOR=1").err.find('\033'), std::string::npos);
  // A terminal that script(1) makes; NO_COLOR and TERM=dumb are obeyed on it.
  const auto on_terminal = [&](const std::string& environment) {
    return place.shell("script -qec '" + environment + " hwsim run nothing.gltf' /dev/null")
               .out.find('\033') != std::string::npos;
  };
  if (place.shell("script -qec true /dev/null").status != 0) return;  // not installed, or no terminals here
  EXPECT_TRUE(on_terminal("TERM=xterm"));
  EXPECT_FALSE(on_terminal("TERM=xterm NO_COLOR=1"));
  EXPECT_FALSE(on_terminal("TERM=dumb"));
}

TEST_F(RunTest, FirstLineComesBeforeTheSceneIsLoaded) {
  const Outcome outcome = run("--no-image --out result");
  EXPECT_EQ(outcome.err.rfind("plan: ", 0), 0u) << outcome.err;
}

}  // namespace
}  // namespace hwsim::cli::test
