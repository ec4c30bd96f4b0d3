// A paper's tables in its layout: nothing lost, nothing twice.
#include "lab/studies/paper_layout.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "lab/base/files.h"
#include "lab/studies/published_runs.h"

namespace hwsim::lab {
namespace {

Reproduction printed(const std::string& paper) {
  Reproduction reproduction{.paper = paper};
  for (cost_models::Cell& cell : published_cells({paper}, ConfigFolder()))
    reproduction.rows.push_back({.cell = std::move(cell)});
  return reproduction;
}

std::vector<PaperTable> tables_of(const std::string& paper) {
  return paper_tables(printed(paper), ConfigFolder().published());
}

TEST(PaperLayout, EveryRowButClaimsStandsInOneCell) {
  for (const char* paper : {"sss", "sbaa", "axaa", "agaa"}) {
    const Reproduction reproduction = printed(paper);
    std::map<std::size_t, int> seen;
    for (const PaperTable& table : paper_tables(reproduction, ConfigFolder().published()))
      for (const PaperTable::Line& line : table.lines)
        for (const auto& cell : line.cells)
          for (const std::size_t row : cell) ++seen[row];
    for (std::size_t i = 0; i < reproduction.rows.size(); ++i)
      EXPECT_EQ(seen[i], reproduction.rows[i].cell.use == cost_models::RowUse::claim ? 0 : 1)
          << reproduction.rows[i].cell.row.id();
  }
}

// SBAA, Table 2: scenes down, rate, method and lighting across; its memory line is a table of its own.
TEST(PaperLayout, TablesLookAsPrinted) {
  const std::vector<PaperTable> tables = tables_of("sbaa");
  ASSERT_EQ(tables.size(), 4u);
  const PaperTable& times = tables[1];
  EXPECT_EQ(times.title, "SBAA, Table 2: Frame time, simple and complex lighting");
  ASSERT_EQ(times.lines.size(), 4u);
  EXPECT_EQ(times.lines[0].label, "SPONZA");
  ASSERT_EQ(times.columns.size(), 16u);
  EXPECT_EQ(times.columns.front(), (std::vector<std::string>{"4x", "Lauritzen2010-deferred-MSAA", "simple"}));
  EXPECT_EQ(times.columns.back(), (std::vector<std::string>{"8x", "SBAA-MERGE3", "complex"}));
  for (const PaperTable::Line& line : times.lines)
    for (const auto& cell : line.cells) EXPECT_EQ(cell.size(), 1u) << line.label;
  EXPECT_EQ(tables[2].lines.size(), 2u) << "MBytes and their changes";
}

TEST(PaperLayout, ATableWithoutALayoutIsShownAllTheSame) {
  Reproduction reproduction = printed("axaa");
  for (ReproducedRow& row : reproduction.rows) row.cell.row.table = "of_a_new_paper";
  const std::vector<PaperTable> tables = paper_tables(reproduction, ConfigFolder().published());
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_EQ(tables[0].line_title, "scene, view");
}

TEST(PaperLayout, ALayoutOfNoFieldIsAMistake) {
  const TemporaryFolder place;
  std::filesystem::create_directories(place.path() / "mapping");
  write_file((place.path() / "mapping" / "layout.csv").string(),
             "table,quantities,title,rows,columns,cut\naxaa_table1,*,T,method,gpu colour,\n");
  try {
    paper_tables(printed("axaa"), place.path().string());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().front().code, "M001");
  }
}

}  // namespace
}  // namespace hwsim::lab
