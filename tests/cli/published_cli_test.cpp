// fit, validate and reproduce, as far as they go without emulating a hundred frames.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "support/places.h"

namespace hwsim::cli::test {
namespace {

using nlohmann::json;

// No row is dropped silently: each has a run or a reason.
TEST(Published, DryRunListsEveryRowWithItsRunOrItsReason) {
  const Workplace place;
  const Outcome outcome = place.hwsim("fit --dry-run --json");
  ASSERT_EQ(outcome.status, 0);
  const json rows = json::parse(outcome.out);
  EXPECT_GT(rows.size(), 300u);
  for (const json& row : rows) {
    const std::string use = row["use"];
    const bool predicted = use == "fitted" || use == "count" || use == "derived";
    EXPECT_TRUE(predicted || !row["reason"].get<std::string>().empty()) << row["row"];
    EXPECT_TRUE(use != "fitted" || !row["run"].get<std::string>().empty()) << row["row"];
  }
}

TEST(Published, PapersAreFilteredAndUnknownOnesRefused) {
  const Workplace place;
  for (const json& row : json::parse(place.hwsim("validate --dry-run --paper axaa --json").out))
    EXPECT_EQ(row["row"].get<std::string>().rfind("axaa_", 0), 0u);
  const Outcome outcome = place.hwsim("fit --paper sbba");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("did you mean `sbaa`?"), std::string::npos) << outcome.err;
}

TEST(Published, ReproduceWritesTheColumnsOfTheContractAndItsPage) {
  const Workplace place;
  const std::string csv = place.hwsim("reproduce wire_aa --format csv --report page.html").out;
  const std::string header = csv.substr(0, csv.find("\r\n"));
  for (const char* column :
       {"document", "table", "value", "predicted", "lo", "hi", "held_out_predicted", "excluded_because"})
    EXPECT_NE(header.find(column), std::string::npos) << column;
  const std::string page = place.read("page.html");
  for (const char* words : {"<!doctype html>", "The paper's tables", "Can I believe it", "other renderers"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  EXPECT_EQ(place.hwsim("reproduce wire_aa --report page.html").status, 3)
      << "a page is not replaced unasked";
}

TEST(Published, APaperWithoutTimesSaysSo) {
  const Workplace place;
  EXPECT_NE(place.hwsim("reproduce wire_aa").out.find("printed no times"), std::string::npos);
}

TEST(Published, ADryRunRefusesAnUnknownGpuAsTheRunDoes) {
  const Workplace place;
  std::filesystem::copy(hwsim::test::source_dir() + "/configs", place / "configs",
                        std::filesystem::copy_options::recursive);
  const std::string gpus = place.read("configs/published/mapping/gpus.csv");
  place.write("configs/published/mapping/gpus.csv",
              std::string(gpus).replace(gpus.find("gf840m"), std::string("gf840m").size(), "gf841m"));
  for (const char* command : {"reproduce axaa --dry-run", "reproduce axaa", "validate --dry-run"}) {
    const Outcome outcome = place.hwsim(command, "HWSIM_CONFIG_DIR=configs");
    EXPECT_EQ(outcome.status, 3) << command;
    for (const char* words : {"error[C016]", "gf841m", "gpus.csv"})
      EXPECT_NE(outcome.err.find(words), std::string::npos) << command << ": " << outcome.err;
  }
}

TEST(Published, AnEmptyTableIsCalledEmpty) {
  const Workplace place;
  std::filesystem::copy(hwsim::test::source_dir() + "/configs", place / "configs",
                        std::filesystem::copy_options::recursive);
  place.write("configs/published/axaa_table1.csv", "");
  const Outcome outcome = place.hwsim("reproduce axaa --dry-run", "HWSIM_CONFIG_DIR=configs");
  EXPECT_EQ(outcome.status, 3);
  for (const char* words : {"error[U015]", "axaa_table1.csv` is empty", "help: its first line must name"})
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
}

TEST(Published, MappingMistakesAreReportedWithTheirLine) {
  const Workplace place;
  std::filesystem::copy(hwsim::test::source_dir() + "/configs", place / "configs",
                        std::filesystem::copy_options::recursive);
  const std::string uses = place.read("configs/published/mapping/uses.csv");
  place.write("configs/published/mapping/uses.csv", uses + "SSS,no_such_table,*,*,*,*,*,*,*,fitted,\n");
  const Outcome outcome = place.hwsim("fit --dry-run", "HWSIM_CONFIG_DIR=configs");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_NE(outcome.err.find("M001"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("uses.csv:"), std::string::npos) << outcome.err;
}

// The guard of CI: one paper whose rows need seconds. The statements about all papers are for `hwsim
// validate`.
TEST(Published, AStatementThatNoLongerHoldsEndsInStatusFour) {
  const Workplace place;
  std::filesystem::copy(hwsim::test::source_dir() + "/configs", place / "configs",
                        std::filesystem::copy_options::recursive);
  ASSERT_NE(place.read("configs/calibration/accuracy.csv").find("\naxaa,"), std::string::npos);
  const Outcome stated = place.hwsim("validate --paper axaa --json", "HWSIM_CONFIG_DIR=configs");
  EXPECT_EQ(stated.status, 0) << stated.err;
  const json report = json::parse(stated.out);
  EXPECT_EQ(report["splits"]["in_sample"]["cells"], 15);
  EXPECT_TRUE(report["not_run"].empty()) << report["not_run"];
  place.write(
      "configs/calibration/accuracy.csv",
      "papers,split,figure,low,high\naxaa,in_sample,mape_pct,0,0.01\nall,in_sample,mape_pct,0,0.01\n");
  const Outcome broken = place.hwsim("validate --paper axaa --progress never", "HWSIM_CONFIG_DIR=configs");
  EXPECT_EQ(broken.status, 4);
  EXPECT_NE(broken.err.find("accuracy: mape_pct of in_sample"), std::string::npos) << broken.err;
}

// A new key of GPU files changes their hashes: the calibrated files are to be written anew then. The clocks
// of the HD 7650M and the Tegra K1 end at a bound, which is not credible: these are no better than
// interpolated.
TEST(Published, ShippedCalibrationIsThatOfTheShippedGpus) {
  const Workplace place;
  for (const char* point : {"axaa:discard=on -g hd4600", "axaa:discard=on -g gf840m", "sbaa_top -g hd5870",
                            "sss_gs -g gtx470", "agaa -g gtx980"}) {
    SCOPED_TRACE(point);
    const Outcome outcome = place.hwsim(
        "run wires --resolution 64x36 --no-image --force --json --out result -t " + std::string(point));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("\"support\": \"calibrated\""), std::string::npos)
        << outcome.out.substr(0, 600);
  }
}

// Neither scenes, techniques nor engines may know the times that they are compared with: without the tables
// and what was fitted to them, every pass stays the same.
TEST(Published, PredictionsNeedNoPublishedTimes) {
  const Workplace place;
  std::filesystem::create_directories(place / "bare");
  std::filesystem::copy(hwsim::test::source_dir() + "/configs/gpus", place / "bare/gpus",
                        std::filesystem::copy_options::recursive);
  for (const char* technique : {"sbaa_merge:msaa=4", "sss_cs", "agaa:msaa=8", "axaa"}) {
    const std::string run =
        "run car_body:triangles=20000 -g gtx980 --resolution 160x90 --no-image --no-cache "
        "--set timing.calibrated=false --json -q -t " +
        std::string(technique);
    const Outcome with = place.hwsim(run), without = place.hwsim(run, "HWSIM_CONFIG_DIR=bare");
    ASSERT_EQ(with.status, 0) << with.err;
    ASSERT_EQ(without.status, 0) << without.err;
    const json a = json::parse(with.out), b = json::parse(without.out);
    ASSERT_FALSE(a["passes"].empty());
    EXPECT_EQ(a["passes"], b["passes"]) << technique;
    EXPECT_EQ(a["frame"], b["frame"]) << technique;
  }
}

}  // namespace
}  // namespace hwsim::cli::test
