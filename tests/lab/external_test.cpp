// Validation on other renderers' times: from kept work, without an emulation and without a fit.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "cost_models/fit.h"
#include "lab/lab.h"
#include "lab/studies/external.h"
#include "lab/studies/published_runs.h"

namespace hwsim::lab {
namespace {

const ExternalValidation& validation() {
  static const ExternalValidation of = [] {
    Lab lab;
    return lab.validate_external();
  }();
  return of;
}

TEST(External, EveryRowIsPredictedOrSaysWhyNot) {
  EXPECT_EQ(validation().rows.size() + validation().not_run.size(), 71u);
  for (const ExternalRow& row : validation().rows) {
    SCOPED_TRACE(row.row);
    EXPECT_TRUE(std::isfinite(row.predicted_ms) && row.predicted_ms > 0.0);
    ASSERT_TRUE(row.interval_ms) << "a GPU without a calibrated relative";
    EXPECT_LT((*row.interval_ms)[0], row.predicted_ms);
    EXPECT_GT((*row.interval_ms)[1], row.predicted_ms);
  }
  for (const UnpredictedRow& row : validation().not_run) EXPECT_FALSE(row.reason.empty()) << row.row;
}

TEST(External, RowsAreNeverFitted) {
  for (const cost_models::Cell& cell : external_cells(ConfigFolder()))
    EXPECT_NE(cell.use, cost_models::RowUse::fitted) << cell.row.id();
  std::set<std::string> tables;
  for (const cost_models::Cell& cell : published_cells({}, ConfigFolder())) tables.insert(cell.row.table);
  for (const ExternalRow& row : validation().rows)
    EXPECT_FALSE(tables.contains(row.row.substr(0, row.row.find(':')))) << row.row;
}

TEST(External, GroupsHoldEachRowOnce) {
  for (const auto* groups : {&validation().gpus, &validation().passes, &validation().techniques}) {
    std::size_t rows = 0;
    for (const auto& [name, errors] : *groups) rows += errors.rows;
    EXPECT_EQ(rows, validation().all.rows);
  }
  for (const auto& [name, errors] : validation().ratios) EXPECT_GT(errors.pairs, 0u) << name;
}

TEST(External, TimesAreThoseThatRunGivesWithWhatAFrameContainsBeside) {
  const std::vector<ExternalRow>& rows = validation().rows;
  double more_lights = 0.0, pairs = 0.0;
  for (const ExternalRow& above : rows)
    for (const ExternalRow& below : rows)
      if (above.gpu == below.gpu && above.technique == below.technique && above.msaa == below.msaa &&
          above.pass == below.pass && above.lights == "1024" && below.lights == "128") {
        more_lights += above.predicted_ms > below.predicted_ms ? 1.0 : 0.0;
        ++pairs;
      }
  EXPECT_EQ(more_lights, pairs);
  EXPECT_GT(pairs, 8.0);
}

}  // namespace
}  // namespace hwsim::lab
