#pragma once
// A paper's tables, published beside predicted, cell by cell.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cost_models/calibration.h"
#include "cost_models/validation.h"
#include "lab/base/observer.h"
#include "lab/base/table.h"

namespace hwsim::lab {

/// Predictions are in the cell's unit; without a calibration they have no intervals.
struct ReproducedRow {
  cost_models::Cell cell;
  std::optional<double> predicted{}, low{}, high{};  ///< 90 % interval
  std::optional<double> held_out{};                  ///< predicted by a fit that did not see the cell's scene
  std::string excluded_because{};                    ///< why the cell is not fitted; empty for fitted ones
};

struct Reproduction {
  std::string paper;
  std::vector<ReproducedRow> rows{};                ///< every row of every table
  std::optional<cost_models::Figures> figures{};    ///< errors of the fitted times; none without any
  std::vector<cost_models::HeldOut> predictions{};  ///< times, in the order of the runs
};

/// Predicts by the calibration's parameters, or by the documented ones where there is none, which the
/// observer is told.
Reproduction reproduce(const std::string& paper, const cost_models::Experiment& experiment,
                       const cost_models::Calibration* calibration, int jobs, Observer& observer);

/// The printed columns with what is known of each cell: the contract of docs/results.md.
Table reproduction_table(const Reproduction& reproduction);
/// The columns that people read, without claims.
Table short_reproduction_table(const Reproduction& reproduction);

nlohmann::ordered_json to_json(const Reproduction& reproduction);
/// The rows as JSON shows them: which run stands for a cell is not part of it. Throws
/// nlohmann::json::exception where a field is missing or of another type.
Reproduction reproduction_from_json(const std::string& paper, const nlohmann::ordered_json& json);

}  // namespace hwsim::lab
