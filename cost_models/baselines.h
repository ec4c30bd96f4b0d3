#pragma once
// What anybody could predict without a simulator.
#include <map>
#include <string>
#include <vector>

#include "cost_models/experiment.h"

namespace hwsim::cost_models {

/// The work of a cell's passes, on the documented GPU.
struct SimpleWork {
  double dram_bytes = 0.0;
  double shaded_samples = 0.0;
  double bandwidth_ms = 0.0;  ///< bytes over the peak bandwidth
};

/// One for each cell; zero where no replay predicts it.
std::vector<SimpleWork> simple_work(const Experiment& experiment);

/// Predicted ms of the cells that `test` marks, by baseline: the geometric mean of the training cells, bytes
/// over bandwidth, and a linear regression on bytes and shaded samples over the training cells.
std::map<std::string, std::vector<double>> baseline_predictions(const Experiment& experiment,
                                                                const std::vector<SimpleWork>& work,
                                                                const std::vector<bool>& train,
                                                                const std::vector<bool>& test);

}  // namespace hwsim::cost_models
