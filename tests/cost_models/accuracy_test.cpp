// The figures that this version states about itself hold, from kept work traces: every row of every paper,
// every split.
#include "cost_models/accuracy.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <thread>

#include "cost_models/fold_optima.h"
#include "cost_models/kept_traces.h"
#include "hwsim/base/diagnostics.h"
#include "support/places.h"

namespace hwsim::cost_models::test {
namespace {

namespace fs = std::filesystem;

std::string config(const std::string& name) { return hwsim::test::source_dir() + "/configs/" + name; }

std::string written(const std::string& text) {
  const std::string path = testing::TempDir() + "/accuracy.csv";
  std::ofstream(path) << text;
  return path;
}

std::string data(const std::string& name) { return hwsim::test::source_dir() + "/tests/data/" + name; }

KeptTraces kept_traces() {
  std::ifstream in(data("published.traces"), std::ios::binary);
  const std::vector<std::uint8_t> bytes((std::istreambuf_iterator<char>(in)), {});
  return decode_kept(bytes);
}

/// The rows of the papers that a statement is about; of all for "all".
std::vector<Cell> cells_of(const std::string& papers) {
  std::vector<Cell> cells = map_rows(load_published(config("published")), config("published"));
  std::erase_if(cells, [&](const Cell& cell) {
    std::string paper = cell.row.document;
    std::transform(paper.begin(), paper.end(), paper.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return papers != "all" && papers != paper;
  });
  return cells;
}

Experiment kept_experiment(const std::string& papers) {
  std::map<std::string, GpuConfig> gpus;
  for (const Cell& cell : cells_of("all"))
    if (cell.has_run && !gpus.contains(cell.run.gpu))
      gpus.emplace(cell.run.gpu, load_gpu(cell.run.gpu, {}, {}, config("gpus")));
  return make_experiment(cells_of(papers), gpus, config("calibration/parameters.csv"),
                         source_of(kept_traces()), [](std::size_t, std::size_t, const std::string&) {});
}

struct Signs {
  int pairs = 0, agree = 0;
};

/// Who of SBAA's Table 2 is faster than the reference of the same scene, samples and lights.
Signs signs_of_table_2(const Experiment& experiment, const std::vector<HeldOutRatio>& ratios) {
  Signs signs;
  for (const HeldOutRatio& r : ratios) {
    const PublishedRow &first = experiment.cells[r.first].row, &second = experiment.cells[r.second].row;
    if (first.table != "sbaa_table2_frame_time_memory" || first.msaa != second.msaa) continue;
    if (first.technique.starts_with("SBAA") == second.technique.starts_with("SBAA")) continue;
    ++signs.pairs;
    signs.agree += (r.predicted > 1.0) == (r.published > 1.0) ? 1 : 0;
  }
  return signs;
}

class Accuracy : public testing::TestWithParam<std::string> {};

TEST_P(Accuracy, IsWhatThisVersionStates) {
  const std::vector<Statement> statements = load_statements(config("calibration/accuracy.csv"));
  const Experiment experiment = kept_experiment(GetParam());
  FitOptions options;
  options.jobs = static_cast<int>(std::thread::hardware_concurrency());
  // From where the fits ended last time; a fit of a few rows takes a second from afar.
  const std::vector<FoldOptimum> known =
      GetParam() == "all" ? load_fold_optima(data("fold_optima.csv"), experiment.parameters)
                          : std::vector<FoldOptimum>();
  const Validation validation = validate(
      experiment, options, [](std::size_t, std::size_t, const std::string&) {}, known);
  std::size_t checked = 0;
  for (const Statement& s : statements) {
    if (s.papers != GetParam()) continue;
    ++checked;
    const double value = measured(s, validation);
    EXPECT_GE(value, s.low) << s.figure << " of " << s.split;
    EXPECT_LE(value, s.high) << s.figure << " of " << s.split;
    RecordProperty(s.split + "_" + s.figure, std::to_string(value));
  }
  EXPECT_GT(checked, 0u);
  if (GetParam() == "all") {
    // Two changes of GRASS at 8x contradict the text and are not fitted.
    const Signs signs = signs_of_table_2(experiment, validation.splits.front().ratios);
    EXPECT_EQ(signs.pairs, 46);
    EXPECT_GE(signs.agree, 29) << "docs/differences.md says how many, and which are missing";
    RecordProperty("table_2_signs", signs.agree);
    EXPECT_EQ(known.size(), validation.optima.size()) << "a fold has no known optimum";
  }
  EXPECT_TRUE(experiment.not_run.empty()) << experiment.not_run.front().reason;
}

INSTANTIATE_TEST_SUITE_P(, Accuracy, testing::Values("all", "axaa"),
                         [](const auto& info) { return info.param; });

TEST(AccuracyStatements, AreAllAboutPapersThatAreTested) {
  for (const Statement& s : load_statements(config("calibration/accuracy.csv")))
    EXPECT_TRUE(s.papers == "all" || s.papers == "axaa") << s.papers << " is checked by no test";
}

TEST(AccuracyStatements, ThatNameNoFigureOrNoRangeAreAllReported) {
  try {
    load_statements(
        written("papers,split,figure,low,high\n"
                "all,in_sample,mape_pct,0,18\n"
                "all,in_sampel,mape_pct,0,18\n"
                "all,counts,kendall,0,1\n"
                "all,in_sample,mape_pct,0,nan\n"
                "all,in_sample,mape_pct,18,0\n"
                "all,in_sample,mape_pct,0,18x\n"));
    FAIL() << "nothing was reported";
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), 5u);
    int line = 3;
    for (const Diagnostic& d : error.diagnostics()) {
      EXPECT_EQ(d.code, "M007");
      EXPECT_EQ(d.place.line, line++);
      EXPECT_FALSE(d.help.empty());
    }
  }
}

TEST(AccuracyStatements, AreBrokenByAFigureOutsideTheirRangeAndByNone) {
  const std::vector<Statement> statements = {{"all", "in_sample", "mape_pct", 0.0, 18.0},
                                             {"all", "counts", "worst_pct", 0.0, 0.1},
                                             {"axaa", "in_sample", "mape_pct", 0.0, 1.0}};
  Validation validation;
  validation.splits.push_back({});
  validation.splits.back().figures.mape_pct = 18.0;
  EXPECT_TRUE(broken_statements(statements, validation, {}).empty());
  validation.splits.back().figures.mape_pct = 18.001;
  validation.memory_worst_pct = 0.2;
  const auto broken = broken_statements(statements, validation, {});
  ASSERT_EQ(broken.size(), 2u);
  EXPECT_EQ(broken.front(), "mape_pct of in_sample is 18, stated are 0 to 18");
  EXPECT_EQ(broken_statements(statements, validation, {"axaa"}).size(), 1u);
  validation.splits.clear();
  EXPECT_EQ(broken_statements(statements, validation, {"axaa"}).size(), 1u)
      << "a missing figure holds nothing";
}

}  // namespace
}  // namespace hwsim::cost_models::test
