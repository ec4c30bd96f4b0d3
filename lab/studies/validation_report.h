#pragma once
// A validation as JSON (the contract of docs/results.md) and as tables.
#include <nlohmann/json.hpp>

#include "cost_models/validation.h"
#include "lab/base/table.h"

namespace hwsim::lab {

nlohmann::ordered_json validation_json(const cost_models::Experiment& experiment,
                                       const cost_models::Validation& validation);

/// A row for each split, its baselines below it.
Table split_table(const cost_models::Experiment& experiment, const cost_models::Validation& validation);

/// A row for each paper and each GPU, in sample.
Table label_table(const cost_models::Experiment& experiment, const cost_models::Validation& validation);

/// The cells furthest from their published values, by split.
Table worst_table(const cost_models::Experiment& experiment, const cost_models::Validation& validation,
                  std::size_t count);

/// "grass, sbaa_top:n=2,msaa=8 on hd5870, frame (sbaa_table2_frame_time_memory:12)".
std::string cell_name(const cost_models::Cell& cell);

}  // namespace hwsim::lab
