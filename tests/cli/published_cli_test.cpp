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

TEST(Published, ReproduceWritesTheColumnsOfTheContractAndPictures) {
  const Workplace place;
  const std::string csv = place.hwsim("reproduce wire_aa --format csv --out pictures").out;
  const std::string header = csv.substr(0, csv.find("\r\n"));
  for (const char* column :
       {"document", "table", "value", "predicted", "lo", "hi", "held_out_predicted", "excluded_because"})
    EXPECT_NE(header.find(column), std::string::npos) << column;
  for (const char* file : {"wire_aa_scatter.svg", "wire_aa_residuals.svg", "wire_aa.csv"})
    EXPECT_TRUE(std::filesystem::exists(place / "pictures" / file)) << file;
  EXPECT_EQ(place.read("pictures/wire_aa_scatter.svg").rfind("<svg", 0), 0u);
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

}  // namespace
}  // namespace hwsim::cli::test
