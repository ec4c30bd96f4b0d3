#pragma once
// The error figures that a version of hwsim states about itself (configs/calibration/accuracy.csv), beside
// those that a validation measured.
#include <string>
#include <vector>

#include "cost_models/validation.h"

namespace hwsim::cost_models {

/// One line of the file: the figure lies in [low, high].
struct Statement {
  std::string papers;  ///< "all", or names of papers with blanks between, as `--paper` takes them
  std::string split;   ///< a split's name, or "counts"
  std::string figure;  ///< for a split mape_pct, median_ape_pct, kendall or coverage90_pct; for counts
                       ///< mape_pct (shaded samples), worst_pct (memory)
  double low = 0.0, high = 0.0;
};

/// Every statement of the file. Throws InputError M007 with all lines that name no figure or hold no range.
std::vector<Statement> load_statements(const std::string& path);

/// What `validation` measured of a statement's figure.
double measured(const Statement& statement, const Validation& validation);

/// A sentence for each statement about `papers` (every paper when empty) that does not hold.
std::vector<std::string> broken_statements(const std::vector<Statement>& statements,
                                           const Validation& validation,
                                           const std::vector<std::string>& papers);

}  // namespace hwsim::cost_models
