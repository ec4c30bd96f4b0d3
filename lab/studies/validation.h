#pragma once
// The fit to the published times, and its errors on data that it did not see.
#include <string>
#include <vector>

#include "cost_models/validation.h"
#include "lab/base/observer.h"
#include "lab/results/run_directory.h"

namespace hwsim::lab {

struct Validation {
  cost_models::Experiment experiment;
  cost_models::Validation figures;
  double fit_wall_s = 0.0;  ///< what the fit to all cells took
};

/// Fits to all cells of the experiment, then to each complement of a fold.
Validation validate(cost_models::Experiment experiment, const cost_models::FitOptions& options,
                    Observer& observer);

/// What `fit` leaves behind: a calibrated file for each GPU, and calibration.json. Throws InputError as
/// RunDirectory does.
void write_calibration(const Validation& validation, const OutPlace& place);

}  // namespace hwsim::lab
