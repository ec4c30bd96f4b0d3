#pragma once
// Times of other renderers (configs/external) beside what the calibration says of their frames: no fit has
// seen them.
#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cost_models/experiment.h"
#include "lab/base/table.h"
#include "lab/point/session.h"
#include "lab/results/result.h"
#include "lab/studies/validation.h"

namespace hwsim::lab {

/// A printed time beside its prediction.
struct ExternalRow {
  std::string row{};  ///< "light_indexed_2012:12"
  std::string gpu{}, technique{}, msaa{}, lights{}, pass{};
  double published_ms = 0.0, predicted_ms = 0.0;
  std::string support{};
  std::optional<std::array<double, 2>> interval_ms{};  ///< 90 %
};

/// Errors of some of them.
struct ExternalErrors {
  std::size_t rows = 0;
  double mape_pct = 0.0, median_ape_pct = 0.0;
  double bias_pct = 0.0;        ///< from the geometric mean of predicted / published
  double coverage90_pct = 0.0;  ///< part of those with an interval
  double width_ratio = 0.0;     ///< median of the interval's end over its begin; 0: none has one
};

/// Ratios of two rows that differ in one thing: what is asked most, and errs least.
struct ExternalRatioErrors {
  std::size_t pairs = 0;
  double mape_pct = 0.0, median_ape_pct = 0.0;
};

struct ExternalValidation {
  ExternalErrors all{};
  NamedValues<ExternalErrors> gpus{}, passes{}, techniques{};
  NamedValues<ExternalRatioErrors> ratios{};  ///< "lights 1024 / 128"
  std::vector<ExternalRow> rows{};
  std::vector<UnpredictedRow> not_run{};
};

/// Rows of configs/external with the runs that stand for them.
std::vector<cost_models::Cell> external_cells(const ConfigFolder& folder);

/// The kept work (configs/external/work.traces), or, with a folder that holds the scenes, what this version
/// emulates. `session` must outlive it. Throws InputError M008 where nothing is kept.
cost_models::TraceSource external_traces(const std::string& scenes_folder, Session& session);

/// `progress` is told the part that is done, and the run that comes.
ExternalValidation validate_external(const cost_models::TraceSource& traces, Session& session,
                                     const std::function<void(double, const std::string&)>& progress = {});

nlohmann::ordered_json to_json(const ExternalValidation& validation);

/// A row for each GPU, pass and technique.
Table external_errors_table(const ExternalValidation& validation);
Table external_ratios_table(const ExternalValidation& validation);
/// Every row, in the order of the tables.
Table external_rows_table(const ExternalValidation& validation);

}  // namespace hwsim::lab
