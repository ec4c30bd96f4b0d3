#include "cost_models/fold_optima.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "cost_models/table_number.h"
#include "hwsim/base/csv.h"
#include "hwsim/base/diagnostics.h"

namespace hwsim::cost_models {
namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}

/// `"`: names of folds are scenes with parameters, which may hold commas.
std::string quoted(const std::string& text) { return "\"" + text + "\""; }

std::optional<Split> split_of(const std::string& name) {
  for (int s = 0; s < kSplitCount; ++s)
    if (split_name(static_cast<Split>(s)) == name) return static_cast<Split>(s);
  return std::nullopt;
}

}  // namespace

std::string to_csv(const std::vector<FoldOptimum>& optima, const std::vector<FittedParameter>& parameters) {
  std::string text = "split,fold";
  for (const FittedParameter& p : parameters) text += "," + quoted(p.id());
  for (const FoldOptimum& optimum : optima) {
    text += "\n" + std::string(split_name(optimum.split)) + "," + quoted(optimum.fold);
    for (const double log_value : optimum.log_values) text += "," + number(std::exp(log_value));
  }
  return text + "\n";
}

std::vector<FoldOptimum> load_fold_optima(const std::string& path,
                                          const std::vector<FittedParameter>& parameters) {
  const CsvFile file = read_csv(path);
  std::vector<FoldOptimum> optima;
  for (std::size_t row = 0; row < file.rows.size(); ++row) {
    const std::vector<std::string>& cells = file.rows[row];
    const auto refuse = [&](const std::string& message) {
      Diagnostic problem{
          .code = "M009", .message = message, .help = "`scripts/keep_traces.sh` writes this file anew"};
      problem.place.file = path;
      problem.place.line = file.lines[row];
      problem.place.column = 1;
      throw InputError(problem);
    };
    const std::string& name = cells[file.column("split")];
    const std::optional<Split> split = split_of(name);
    if (!split) refuse("`" + name + "` is no split of a validation");
    FoldOptimum optimum{*split, cells[file.column("fold")], {}};
    for (const FittedParameter& p : parameters) {
      const auto column = std::find(file.header.begin(), file.header.end(), p.id()) - file.header.begin();
      const bool named = column < static_cast<std::ptrdiff_t>(cells.size());
      const std::optional<double> value =
          named ? table_number(cells[static_cast<std::size_t>(column)], {1e-300, 1e300}) : p.start;
      if (!value) refuse("`" + cells[static_cast<std::size_t>(column)] + "` is no value of `" + p.id() + "`");
      optimum.log_values.push_back(std::log(*value));
    }
    optima.push_back(std::move(optimum));
  }
  return optima;
}

}  // namespace hwsim::cost_models
