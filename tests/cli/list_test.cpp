#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/program.h"
#include "support/places.h"

namespace hwsim::cli::test {
namespace {

using nlohmann::json;

TEST(List, EveryCatalogIsListedInEveryFormat) {
  const Workplace place;
  for (const std::string what :
       {"gpus", "scenes", "techniques", "counters", "papers", "settings", "codes", "sources"}) {
    const json rows = json::parse(place.hwsim("list " + what + " --json").out);
    EXPECT_GT(rows.size(), 3u) << what;
    const std::string csv = place.hwsim("list " + what + " --format csv").out;
    EXPECT_EQ(csv.find("n/a"), std::string::npos) << what;
    EXPECT_EQ(place.hwsim("list " + what + " --format md").out.rfind("| ", 0), 0u) << what;
  }
}

// The Tegra K1's clock ends at a bound of its range; the GTX 570 extends the GTX 470, which was fitted.
TEST(List, GpusSayWhatTheirCalibrationIs) {
  const Workplace place;
  std::map<std::string, std::string> calibrated;
  for (const json& row : json::parse(place.hwsim("list gpus --json").out))
    calibrated[row["id"].get<std::string>()] = row["calibrated"].get<std::string>();
  EXPECT_EQ(calibrated["gtx980"], "yes");
  EXPECT_EQ(calibrated["tegrak1"], "in part");
  EXPECT_EQ(calibrated["gtx570"], "by gtx470");
  EXPECT_EQ(calibrated["rtx4090"], "no");
  std::filesystem::create_directories(place / "bare");
  std::filesystem::copy(hwsim::test::source_dir() + "/configs/gpus", place / "bare/gpus",
                        std::filesystem::copy_options::recursive);
  for (const json& row : json::parse(place.hwsim("list gpus --json", "HWSIM_CONFIG_DIR=bare").out))
    EXPECT_EQ(row["calibrated"], "no") << row["id"];
}

TEST(List, FormatWritesToAFile) {
  const Workplace place;
  const Outcome outcome = place.hwsim("list gpus --format csv=gpus.csv --format md");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out.rfind("| ", 0), 0u);
  EXPECT_EQ(place.read("gpus.csv").rfind("id,title", 0), 0u);
}

TEST(Formats, FileThatExistsIsReplacedByForceAlone) {
  const Workplace place;
  place.write("thesis.txt", "precious");
  const Outcome refused = place.hwsim("list gpus --format csv=thesis.txt");
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find("U013"), std::string::npos) << refused.err;
  EXPECT_EQ(place.read("thesis.txt"), "precious");
  EXPECT_EQ(place.hwsim("list gpus --format csv=thesis.txt --force").status, 0);
  EXPECT_EQ(place.read("thesis.txt").rfind("id,title", 0), 0u);
  EXPECT_EQ(place.hwsim("list gpus --format csv=x --format json=x").status, 2);
}

TEST(Formats, LinksAndPipesStayWhatTheyAre) {
  const Workplace place;
  place.write("target.csv", "old");
  std::filesystem::create_symlink("target.csv", place / "link");
  EXPECT_EQ(place.hwsim("list gpus --format csv=link --force").status, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(place / "link"));
  EXPECT_EQ(place.read("target.csv").rfind("id,title", 0), 0u);
  EXPECT_EQ(place.hwsim("list gpus --format csv=/dev/stdout").out.rfind("id,title", 0), 0u);
}

TEST(List, PublishedTablesAreReadByRfc4180) {
  const Workplace place;
  std::filesystem::create_directories(place / "configs/gpus");
  std::filesystem::create_directories(place / "configs/published");
  place.write("configs/published/t.csv", "a,\"b,c\"\r\n\"x \"\"y\"\"\",\"two\r\nlines\"\r\n");
  const json rows = json::parse(place.hwsim("show t --json", "HWSIM_CONFIG_DIR=configs").out);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0]["a"], "x \"y\"");
  EXPECT_EQ(rows[0]["b,c"], "two\r\nlines");
  EXPECT_EQ(json::parse(place.hwsim("list tables --json", "HWSIM_CONFIG_DIR=configs").out)[0]["rows"], 1);
}

TEST(Show, OriginSaysWhereAValueWasSet) {
  const Workplace place;
  const json rows = json::parse(place.hwsim("show gtx980 --origin --json --set gpu.core_clock_mhz=1000").out);
  bool found = false;
  for (const json& row : rows)
    if (row["key"] == "core_clock_mhz") {
      found = true;
      EXPECT_EQ(row["value"], "1000.0");
      EXPECT_EQ(row["origin"], "--set");
    }
  EXPECT_TRUE(found);
}

TEST(Config, ShownFileLoadsToTheSameNumbers) {
  const Workplace place;
  place.write("shown.toml", place.hwsim("config show gtx980 --origin").out);
  EXPECT_EQ(place.hwsim("config check shown.toml").status, 0);
  EXPECT_EQ(json::parse(place.hwsim("config diff gtx980 shown.toml --json").out), json::array());
  EXPECT_NE(json::parse(place.hwsim("config diff gtx980 gtx470 --json").out), json::array());
}

TEST(Config, SchemaIsJson) {
  const Workplace place;
  EXPECT_TRUE(json::parse(place.hwsim("config schema").out).contains("properties"));
}

TEST(SceneCheck, CountsAndNotes) {
  const Workplace place;
  place.write("triangle.gltf", kTriangleGltf);
  const Outcome outcome = place.hwsim("scene check triangle.gltf --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json rows = json::parse(outcome.out);
  EXPECT_EQ(rows[0]["drawn_triangles"], 1);
  EXPECT_EQ(rows[0]["materials"], 0) << "the loader's own is none of the file's";
  EXPECT_NE(rows[0]["notes"].dump().find("0 materials: "), std::string::npos) << rows[0]["notes"];
  EXPECT_FALSE(rows[0]["notes"].empty()) << "normals, a light and a camera were added";
}

TEST(Doctor, FindsThisInstallationHealthy) {
  const Workplace place;
  const Outcome outcome = place.hwsim("doctor --json");
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  for (const json& row : json::parse(outcome.out)) EXPECT_EQ(row["state"], "ok") << row;
}

TEST(Doctor, FailsWhenAPartIsMissing) {
  const Workplace place;
  const Outcome outcome = place.hwsim("doctor --json", "HWSIM_CONFIG_DIR=/nowhere");
  EXPECT_EQ(outcome.status, 1);
}

TEST(Cache, PruneRemovesOldFilesAndKeepsStrangers) {
  const Workplace place;
  const std::string environment = "HWSIM_CACHE=cache";
  std::filesystem::create_directories(place / "cache/scenes");
  place.write("cache/scenes/old.glb", "old");
  place.write("cache/scenes/new.glb", "new");
  place.write("cache/strange.txt", "not ours");
  ASSERT_EQ(place.shell("touch -d '40 days ago' cache/scenes/old.glb").status, 0);
  EXPECT_EQ(place.hwsim("cache prune --dry-run", environment).status, 0);
  EXPECT_EQ(place.listing("cache/scenes"), "new.glb old.glb");
  EXPECT_EQ(place.hwsim("cache prune", environment).status, 0);
  EXPECT_EQ(place.listing("cache/scenes"), "new.glb");
  EXPECT_EQ(place.hwsim("cache prune --all", environment).status, 0);
  EXPECT_EQ(place.listing("cache"), "scenes strange.txt");
  EXPECT_EQ(place.listing("cache/scenes"), "");
}

TEST(Formats, FileThatCannotBeWrittenIsToldBeforeTheWork) {
  const Workplace place;
  place.write("triangle.gltf", kTriangleGltf);
  for (const char* file : {"none/x.csv", "."}) {
    const Outcome outcome =
        place.hwsim(std::string("run triangle.gltf --resolution 64x36 --out result --format csv=") + file);
    EXPECT_EQ(outcome.status, 3) << file;
    EXPECT_NE(outcome.err.find("U010"), std::string::npos) << outcome.err;
    EXPECT_EQ(place.listing(), "triangle.gltf") << file;
  }
}

// Every source key that the program prints resolves in its own output.
TEST(Show, OriginsEndWithTheDocumentsThatTheyName) {
  const Workplace place;
  const std::string text = place.hwsim("show gtx980 --origin").out;
  for (const char* document : {"[JIA]", "Dissecting the NVidia Turing T4", "[GM204-WP]", "white paper"})
    EXPECT_NE(text.find(document), std::string::npos) << document;
  EXPECT_EQ(place.hwsim("show gtx980").out.find("Dissecting"), std::string::npos);
  for (const char* words : {"show source B3D-F", "show B3D-F"})
    EXPECT_NE(place.hwsim(words).out.find("Beyond3D"), std::string::npos) << words;
  const Outcome typing = place.hwsim("show B3D-FF");
  EXPECT_EQ(typing.status, 3);
  EXPECT_NE(typing.err.find("did you mean `B3D-F`?"), std::string::npos) << typing.err;
}

}  // namespace
}  // namespace hwsim::cli::test
