// The published tables as data: every row is there, has a use with a reason, and stands for a run.
#include "cost_models/published.h"

#include "cost_models/parameters.h"
#include "hwsim/base/diagnostics.h"
#include "support/places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

namespace hwsim::cost_models::test {
namespace {

const std::string kPublished = hwsim::test::source_dir() + "/configs/published";

std::vector<Cell> all_cells() { return map_rows(load_published(kPublished), kPublished); }

/// The cell of a row, by the file and a predicate.
const Cell& find(const std::vector<Cell>& cells, const std::string& table, const std::string& scene,
                 const std::string& technique, const std::string& msaa, const std::string& surfaces,
                 const std::string& lighting, const std::string& pass) {
  for (const Cell& cell : cells) {
    const PublishedRow& r = cell.row;
    if (r.table == table && r.scene == scene && r.technique == technique && r.msaa == msaa &&
        r.surfaces == surfaces && r.lighting == lighting && r.pass == pass &&
        (r.quantity == "time_ms" || r.quantity == "percent_change_time"))
      return cell;
  }
  throw std::runtime_error("no such row");
}

// published/README.md: 318 rows of tables with 317 values, and 113 claims.
TEST(Published, EveryRowIsLoaded) {
  std::map<std::string, int> rows;
  int numbers = 0;
  for (const PublishedRow& row : load_published(kPublished)) {
    const bool claims = row.table.ends_with("_claims");
    ++rows[claims ? "claims" : "tables"];
    if (!claims && row.printed != "NA") ++numbers;
  }
  EXPECT_EQ(rows["tables"], 318);
  EXPECT_EQ(rows["claims"], 113);
  EXPECT_EQ(numbers, 317);
}

/// "M010 message; help" that reading ends in, from a table's third line; empty where it is read.
template <class Read>
std::string problem_of(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    const Diagnostic& problem = error.diagnostics().front();
    EXPECT_EQ(problem.place.line, 3);
    EXPECT_FALSE(problem.help.empty());
    return problem.code + " " + problem.message + "; " + problem.help;
  }
  return "";
}

/// What a table ends in whose second row has these.
std::string problem_with(const std::string& quantity, const std::string& value, const std::string& unit) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / "hwsim_published_numbers";
  fs::remove_all(folder);
  fs::create_directories(folder);
  std::ofstream(folder / "t.csv")
      << "document,gpu,resolution,scene,view,technique,msaa,surfaces_or_aggregates,lighting,pass,quantity,"
         "value,unit,note\nD,G,1280x720,S,V,T,8,,,frame,time_ms,1.5,ms,\nD,G,1280x720,S,V,T,8,,,frame," +
             quantity + "," + value + "," + unit + ",\n";
  return problem_of([&] { load_published(folder.string()); });
}

std::string message_for(const std::string& value) {
  const std::string problem = problem_with("time_ms", value, "ms");
  return problem.substr(0, problem.find(';'));
}

// 10.6 s were fitted as 10.6 ms.
TEST(Published, UnitThatIsNotItsQuantitysIsRefusedWithItsLine) {
  EXPECT_EQ(problem_with("time_ms", "10.6", "s"),
            "M010 `s` is no value of `unit`; write `ms`, the unit of `time_ms`");
  for (const char* unit : {"", "us", "MS", " ms", "ms ", "%", "count"})
    EXPECT_NE(problem_with("time_ms", "NA", unit), "") << unit;
  for (const auto& [quantity, unit] :
       {std::pair{"fps", "ms"}, std::pair{"memory_mbytes", "GB"}, std::pair{"shaded_samples", ""},
        std::pair{"speedup", "%"}, std::pair{"percent_change_time", "ms"}, std::pair{"claim", ""}})
    EXPECT_NE(problem_with(quantity, "2", unit), "") << quantity;
  EXPECT_EQ(problem_with("claim", "2", "lights"), "");
  EXPECT_EQ(problem_with("speedup", "2", "x"), "");
  EXPECT_NE(problem_with("time_s", "2", "s").find("`time_s` is no value of `quantity`; write one of claim"),
            std::string::npos);
}

// 0 was read as no prior, and so were 1 and -3.
TEST(Published, PriorOfAParameterIsAFactorAboveOneOrNone) {
  const std::string file = (std::filesystem::path(testing::TempDir()) / "hwsim_prior_factor.csv").string();
  const auto prior = [&](const std::string& factor) {
    std::ofstream(file) << "scope,member,name,start,low,high,prior_factor,meaning\n"
                           "scene,a,geometry_load,1,0.5,2,1.5,\nscene,b,geometry_load,1,0.5,2," +
                               factor + ",\n";
    return load_parameters(file, {}).at(1).prior_log_sd;
  };
  for (const char* factor : {"0", "1", "-3", "nan", "inf", "", "file", "None", "2x"})
    EXPECT_EQ(problem_of([&] { prior(factor); }),
              "M003 `" + std::string(factor) +
                  "` is no value of `prior_factor`; write a number above 1, the " +
                  "factor by which the value is likely off its start, or none");
  EXPECT_EQ(prior("none"), 0.0);
  EXPECT_EQ(prior("1.5"), std::log(1.5));
}

TEST(Published, ValueThatIsNoFiniteNumberInItsRangeIsRefusedWithItsLine) {
  for (const char* value : {"nan", "inf", "-inf", "-5", "0", "abc", "1.5x", "", "1e400", " 2", "0x10"})
    EXPECT_EQ(message_for(value), "M010 `" + std::string(value) + "` is no value of `value`");
  for (const char* value : {"2", "0.5", "1e3", "NA"}) EXPECT_EQ(message_for(value), "") << value;
}

// The place was filled for ever.
TEST(Published, AValueThatNamesItsOwnPlaceIsFilledInOnce) {
  std::vector<PublishedRow> rows = load_published(kPublished);
  for (PublishedRow& row : rows)
    if (row.surfaces == "2") row.surfaces = "{surfaces}";
  std::set<std::string> techniques;
  try {
    for (const Cell& cell : map_rows(rows, kPublished)) techniques.insert(cell.run.technique);
  } catch (const InputError&) {
    return;  // rules that match no row any more
  }
  EXPECT_TRUE(techniques.contains("sbaa_top:n={surfaces},msaa=8"));
}

// A fuzzer's find: a message for each of 200 rows.
TEST(Published, ManyProblemsEndInAsManyMessagesAsCanBeRead) {
  std::vector<PublishedRow> rows = load_published(kPublished);
  for (PublishedRow& row : rows) row.resolution.clear();
  try {
    map_rows(rows, kPublished);
    FAIL() << "rows without a resolution have no run";
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), kProblemsShown);
    EXPECT_NE(error.diagnostics().front().message.find("it has no resolution"), std::string::npos);
    EXPECT_NE(error.diagnostics().back().message.find(" further problems"), std::string::npos);
  }
}

TEST(Published, EveryRowHasAUseAndWhatIsNotFittedAReason) {
  std::map<RowUse, int> uses;
  std::set<std::string> ids;
  for (const Cell& cell : all_cells()) {
    ++uses[cell.use];
    EXPECT_TRUE(ids.insert(cell.row.id()).second) << cell.row.id();
    if (cell.use == RowUse::fitted) {
      EXPECT_TRUE(cell.has_run) << cell.row.id();
      EXPECT_GT(cell.published, 0.0) << cell.row.id();
      EXPECT_FALSE(cell.passes.empty()) << cell.row.id();
    } else if (cell.use != RowUse::count) {
      EXPECT_FALSE(cell.reason.empty()) << cell.row.id();
    }
  }
  // SSS 8 frames + 6 without the exit + 18 stages, SBAA 24 analyses + 16 references + 46 of 48 changes,
  // AXAA 15 of 16, AGAA 70 stages.
  EXPECT_EQ(uses[RowUse::fitted], 8 + 6 + 18 + 24 + 16 + 46 + 15 + 70);
  EXPECT_EQ(uses[RowUse::count], 8 + 24 - 3 + 8);
}

TEST(Published, PercentagesBecomeTheAbsoluteTimesThatTheyWerePrintedFrom) {
  const std::vector<Cell> cells = all_cells();
  const Cell& top =
      find(cells, "sbaa_table2_frame_time_memory", "SPONZA", "SBAA-TOP", "8", "2", "simple", "frame");
  EXPECT_NEAR(top.published, 7.70, 0.005);
  EXPECT_EQ(top.run.technique, "sbaa_top:n=2,msaa=8");
  EXPECT_EQ(top.run.gpu, "hd5870");
  EXPECT_EQ(top.run.width_px, 1280);
  EXPECT_NE(top.run.settings.find("scene.lights=simple"), std::string::npos) << top.run.settings;
  // README 18: all of them lie within 0.011 ms of a multiple of 0.1 ms.
  for (const Cell& cell : cells)
    if (cell.row.quantity == "percent_change_time") {
      EXPECT_NEAR(cell.published, std::round(cell.published * 10.0) / 10.0, 0.0111) << cell.row.id();
    }
}

TEST(Published, RunWithoutItsLightsHasTheOtherSettingsAsTheyWere) {
  const RunSpec run{.scene = "metal",
                    .camera = "0",
                    .technique = "none",
                    .gpu = "gtx980",
                    .width_px = 640,
                    .height_px = 360,
                    .settings = "scene.point_lights=16 scene.light_range=1 scene.shadows=true",
                    .unlit = "scene.point_lights=0"};
  RunSpec expected = run;
  expected.settings = "scene.point_lights=0 scene.light_range=1 scene.shadows=true";
  expected.unlit = "";
  EXPECT_EQ(without_lights(run), expected);
}

TEST(Published, ContradictedRowsAreLeftOut) {
  for (const Cell& cell : all_cells()) {
    const PublishedRow& r = cell.row;
    const bool contradicted = r.quantity == "fps";
    // The paper's own "2.3 times faster" is of this row.
    if (r.gpu == "Radeon HD 7650M" && r.technique == "CMAA") {
      EXPECT_EQ(cell.use, RowUse::fitted) << r.id();
    }
    const bool sum = r.document == "AGAA" && r.pass == "frame" && r.quantity == "time_ms";
    if (contradicted) {
      EXPECT_EQ(cell.use, RowUse::excluded) << r.id();
    }
    if (sum) {
      EXPECT_EQ(cell.use, RowUse::derived) << r.id();
    }
  }
}

TEST(Published, RowsHaveTheUnitOfWhatTheyCount) {
  int mib = 0;
  for (const Cell& cell : all_cells()) {
    if (cell.use == RowUse::claim) continue;
    const bool memory = cell.row.quantity.find("memory") != std::string::npos;
    const bool samples = cell.row.quantity.find("shaded") != std::string::npos;
    EXPECT_EQ(cell.unit, memory ? "mib" : samples ? "samples" : "ms") << cell.row.id();
    if (memory && cell.use == RowUse::derived) {
      ++mib;
      EXPECT_GT(cell.published, 80.0) << cell.row.id();  // percentages of 144.1 and 284.8 MiB, made absolute
      EXPECT_LT(cell.published, 160.0) << cell.row.id();
    }
  }
  EXPECT_EQ(mib, 6);
}

TEST(Published, PatternsSelectPasses) {
  EXPECT_TRUE(pass_matches("*", "gbuffer"));
  EXPECT_TRUE(pass_matches("light* resolve", "light_complex"));
  EXPECT_TRUE(pass_matches("light* resolve", "resolve"));
  EXPECT_FALSE(pass_matches("light* resolve", "resolve2"));
  EXPECT_FALSE(pass_matches("* !shadow*", "shadow_clear"));
  EXPECT_TRUE(pass_matches("* !shadow*", "gbuffer"));
}

}  // namespace
}  // namespace hwsim::cost_models::test
