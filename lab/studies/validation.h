#pragma once
// The fit to the published times, and its errors on data that it did not see.
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cost_models/validation.h"
#include "lab/base/observer.h"
#include "lab/base/table.h"
#include "lab/results/result.h"
#include "lab/results/run_directory.h"

namespace hwsim::lab {

/// What was fitted to, and where the fits ended.
struct FittedModel {
  cost_models::Experiment experiment;
  cost_models::Validation figures;
  double fit_wall_s = 0.0;  ///< what the fit to all cells took
};

/// A published value and how far its prediction is from it.
struct CellError {
  std::string row{};   ///< "sbaa_table2_frame_time_memory:12"
  std::string cell{};  ///< what the row is of
  double ape_pct = 0.0;
};

/// Errors of the predicted times of some cells.
struct Errors {
  std::size_t cells = 0;
  double mape_pct = 0.0, median_ape_pct = 0.0;
  std::optional<CellError> worst{};
  double kendall = 1.0;
  double coverage90_pct = 0.0;
  double width_ratio = 1.0;  ///< median of high / low of the 90 % intervals
};

/// Errors of the predicted ratios of two techniques' times, pair by pair.
struct RatioErrors {
  std::size_t pairs = 0;
  double median_ape_pct = 0.0;
  double coverage90_pct = 0.0;
  double width_ratio = 1.0;  ///< as of Errors
};

struct SplitErrors {
  std::string split{};  ///< "leave_scene_out"
  Errors errors{};
  NamedValues<Errors> baselines{};  ///< what anybody could predict without a simulator
  RatioErrors ratios{};
};

/// Errors of what is counted, not timed.
struct CountErrors {
  double error_pct = 0.0;
  std::size_t cells = 0;
};

struct UnpredictedRow {
  std::string row{}, reason{};
};

struct Validation {
  std::vector<SplitErrors> splits{};
  NamedValues<Errors> papers{}, gpus{};  ///< in sample
  CountErrors shaded_samples{};          ///< mean
  CountErrors memory{};                  ///< worst
  std::size_t parameters = 0, fitted_values = 0;
  std::vector<UnpredictedRow> not_run{};
  std::shared_ptr<const FittedModel> model{};  ///< what was validated; none in a validation that was read
};

/// Fits to all cells of the experiment, then to each complement of a fold.
FittedModel fit_and_validate(cost_models::Experiment experiment, const cost_models::FitOptions& options,
                             Observer& observer);

Validation errors_of(std::shared_ptr<const FittedModel> model);

nlohmann::ordered_json to_json(const Validation& validation);
/// Throws nlohmann::json::exception where a field is missing or of another type.
Validation validation_from_json(const nlohmann::ordered_json& json);

/// What `fit` leaves behind: a calibrated file for each GPU, and calibration.json. Throws InputError as
/// RunDirectory does.
void write_calibration(const FittedModel& model, const OutPlace& place);

/// A row for each split, its baselines below it.
Table split_table(const Validation& validation);

/// A row for each split: ratios of two techniques' times on one scene and GPU.
Table ratio_table(const Validation& validation);

/// A row for each paper and each GPU, in sample.
Table label_table(const Validation& validation);

/// The cells furthest from their published values, by split.
Table worst_table(const FittedModel& model, std::size_t count);

/// Every parameter with where it began and where the fit ended.
Table parameter_table(const FittedModel& model);

/// "grass, sbaa_top:n=2,msaa=8 on hd5870, frame (sbaa_table2_frame_time_memory:12)".
std::string cell_name(const cost_models::Cell& cell);

}  // namespace hwsim::lab
