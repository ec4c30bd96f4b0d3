// Published runs as requests: their settings are those of `--set`, by the one declaration.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "algos/techniques.h"
#include "lab/lab.h"
#include "lab/studies/published_runs.h"
#include "lab/workbench.h"

namespace hwsim::lab {
namespace {

using cost_models::RunSpec;
namespace fs = std::filesystem;

RunSpec run_with(const std::string& settings) {
  return {.scene = "grass",
          .camera = "close",
          .technique = "msaa4x",
          .gpu = "gtx980",
          .width_px = 640,
          .height_px = 360,
          .settings = settings,
          .unlit = {}};
}

TEST(PublishedRequests, RunIsTheRequestThatItsSettingsSay) {
  const Request request = request_of(
      run_with("scene.point_lights=16 scene.light_range=0.5 scene.lights=complex scene.shadows=false"));
  const View expected{.scene = "grass",
                      .resolution = {640, 360},
                      .camera = "close",
                      .point_lights = 16,
                      .light_range = 0.5,
                      .lights = "complex",
                      .shadows = false};
  EXPECT_EQ(request.view, expected);
  EXPECT_EQ(request.techniques, std::vector<std::string>{"msaa4x"});
  EXPECT_EQ(request.gpus, std::vector<std::string>{"gtx980"});
  EXPECT_EQ(request_of(run_with("")).view.point_lights, View().point_lights);
}

TEST(PublishedRequests, EverySettingOfASceneCanBeSaid) {
  View plain = request_of(run_with("")).view;
  for (const Field& field : fields_of(plain)) {
    if (field.info.group != "scene") continue;
    std::string value = field.info.choices.empty()
                            ? "1"
                            : std::string(field.info.choices.substr(field.info.choices.rfind('|') + 1));
    if (std::holds_alternative<bool*>(field.slot)) value = "false";
    if (const auto* real = std::get_if<double*>(&field.slot); real && **real == 1.0) value = "0.5";
    if (field.info.key.low >= 1.0)
      value = std::to_string(static_cast<int>(std::min(64.0, field.info.key.high)));
    const std::string name(field.info.key.name);
    EXPECT_NE(request_of(run_with("scene." + name + "=" + value)).view, plain) << name;
  }
}

TEST(PublishedRequests, UnlitRunsHaveNoLightsBesideThoseOfTheScene) {
  std::size_t unlit = 0;
  for (const cost_models::Cell& cell : published_cells({}, ConfigFolder())) {
    if (!cell.has_run) continue;
    const View view = request_of(cell.run).view;
    ASSERT_EQ(cell.run.unlit.empty(), view.point_lights == 0 && view.lights != "complex") << cell.row.id();
    if (cell.run.unlit.empty()) continue;
    ++unlit;
    View expected = view;
    expected.point_lights = 0;
    if (view.lights == "complex") expected.lights = "simple";
    EXPECT_EQ(request_of(cost_models::without_lights(cell.run)).view, expected) << cell.row.id();
  }
  EXPECT_GT(unlit, 100u);
}

// What is timed is what a user gets and what docs/quality.md judges: the published runs of AGAA and SBAA set
// nothing but what their tables vary, the samples and the surfaces.
TEST(PublishedRequests, TimedTechniquesAreTheirDefaults) {
  std::set<std::string> seen;
  for (const cost_models::Cell& cell : published_cells({}, ConfigFolder())) {
    const bool own = cell.row.technique == "AGAA" || cell.row.technique.rfind("SBAA-", 0) == 0;
    if (!cell.has_run || !own) continue;
    const algos::TechniqueChoice choice = algos::parse_technique(cell.run.technique);
    std::string text = algos::technique_text(choice);
    for (const char* varied : {"n=3", "msaa=4", "msaa=32"})
      if (const std::size_t at = text.find(varied); at != text.npos)
        text.erase(at - 1, std::string(varied).size() + 1);  // with the colon or comma before it
    EXPECT_TRUE(text == "agaa" || text == "sbaa_top" || text == "sbaa_merge") << cell.run.technique;
    seen.insert(text);
  }
  EXPECT_EQ(seen.size(), 3u);
}

TEST(PublishedRequests, SettingsThatNoRequestTakesAreRefusedWithTheirFile) {
  const test::Workbench bench;
  fs::copy(ConfigFolder().path(), bench.path("configs"), fs::copy_options::recursive);
  const std::string file = bench.path("configs/published/mapping/scenes.csv");
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  const auto code_with = [&](const std::string& good, const std::string& bad) {
    std::string changed = text.str();
    changed.replace(changed.find(good), good.size(), bad);
    std::ofstream(file) << changed;
    try {
      published_cells({}, ConfigFolder(bench.path("configs")));
    } catch (const InputError& error) {
      EXPECT_EQ(error.diagnostics().front().place.file, file);
      return error.diagnostics().front().code;
    }
    return std::string();
  };
  const std::string lights = "scene.point_lights=16";
  EXPECT_EQ(code_with(lights, lights), "");
  EXPECT_EQ(code_with(lights, "scene.point_lights=9999"), "C014");
  EXPECT_EQ(code_with("scene.lights=complex", "scene.lights=dim"), "U003");
  EXPECT_NE(code_with(lights, "scene.point_lights=nan"), "");
  EXPECT_NE(code_with(lights, "lights"), "");
}

}  // namespace
}  // namespace hwsim::lab
