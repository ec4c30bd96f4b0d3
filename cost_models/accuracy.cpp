#include "cost_models/accuracy.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "cost_models/table_number.h"
#include "hwsim/base/csv.h"
#include "hwsim/base/diagnostics.h"

namespace hwsim::cost_models {
namespace {

constexpr std::string_view kCounts = "counts";

/// A figure's name and where a split holds it.
struct SplitFigure {
  std::string_view name;
  double Figures::*value;
};
constexpr std::array<SplitFigure, 4> kSplitFigures = {{{"mape_pct", &Figures::mape_pct},
                                                       {"median_ape_pct", &Figures::median_ape_pct},
                                                       {"kendall", &Figures::kendall},
                                                       {"coverage90_pct", &Figures::coverage90_pct}}};

/// The same of the counts.
struct CountFigure {
  std::string_view name;
  double Validation::*value;
};
constexpr std::array<CountFigure, 2> kCountFigures = {
    {{"mape_pct", &Validation::shaded_samples_mape_pct}, {"worst_pct", &Validation::memory_worst_pct}}};

template <class Figure, std::size_t N>
const Figure* find(const std::array<Figure, N>& figures, std::string_view name) {
  for (const Figure& figure : figures)
    if (figure.name == name) return &figure;
  return nullptr;
}

bool is_split(std::string_view name) {
  for (int s = 0; s < kSplitCount; ++s)
    if (split_name(static_cast<Split>(s)) == name) return true;
  return false;
}

bool has_figure(const Statement& s) {
  if (s.split == kCounts) return find(kCountFigures, s.figure) != nullptr;
  return is_split(s.split) && find(kSplitFigures, s.figure) != nullptr;
}

double number(const std::string& text) { return table_number(text).value_or(std::nan("")); }

std::string about(const std::vector<std::string>& papers) {
  std::string names;
  for (const std::string& paper : papers) names += (names.empty() ? "" : " ") + paper;
  return names.empty() ? "all" : names;
}

std::string rounded(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

}  // namespace

std::vector<Statement> load_statements(const std::string& path) {
  const CsvFile file = read_csv(path);
  std::vector<Statement> statements;
  std::vector<Diagnostic> problems;
  for (std::size_t i = 0; i < file.rows.size(); ++i) {
    const auto text = [&](std::string_view column) { return file.rows[i][file.column(column)]; };
    const Statement s{text("papers"), text("split"), text("figure"), number(text("low")),
                      number(text("high"))};
    const auto problem = [&](const std::string& message, const std::string& help) {
      problems.push_back({.code = "M007", .message = message, .help = help});
      problems.back().place.file = path;
      problems.back().place.line = file.lines[i];
      problems.back().place.column = 1;
    };
    if (!has_figure(s))
      problem(
          "no figure of a validation is called `" + s.figure + "` of `" + s.split + "`",
          "splits are those of `hwsim validate`, with mape_pct, median_ape_pct, kendall or coverage90_pct; "
          "counts have mape_pct and worst_pct");
    if (!(std::isfinite(s.low) && std::isfinite(s.high) && s.low <= s.high))
      problem("`" + text("low") + "` to `" + text("high") + "` is no range",
              "two finite numbers, the smaller one first");
    statements.push_back(s);
  }
  if (!problems.empty()) throw InputError(problems);
  return statements;
}

double measured(const Statement& statement, const Validation& validation) {
  if (statement.split == kCounts) return validation.*find(kCountFigures, statement.figure)->value;
  for (const SplitResult& split : validation.splits)
    if (split_name(split.split) == statement.split)
      return split.figures.*find(kSplitFigures, statement.figure)->value;
  return std::nan("");
}

std::vector<std::string> broken_statements(const std::vector<Statement>& statements,
                                           const Validation& validation,
                                           const std::vector<std::string>& papers) {
  std::vector<std::string> broken;
  for (const Statement& s : statements) {
    if (s.papers != about(papers)) continue;
    const double value = measured(s, validation);
    if (!(value >= s.low && value <= s.high))
      broken.push_back(s.figure + " of " + s.split + " is " + rounded(value) + ", stated are " +
                       rounded(s.low) + " to " + rounded(s.high));
  }
  return broken;
}

}  // namespace hwsim::cost_models
