#pragma once
// Times of all cells for a set of parameter values, with exact derivatives: the queue engine over Jets.
#include <span>
#include <vector>

#include "cost_models/experiment.h"

namespace hwsim::cost_models {

/// Of one cell. Derivatives are those of ln(time) by ln(parameter), one for each parameter of the experiment.
struct Prediction {
  double ms = 0.0;
  std::vector<double> gradient;
};

/// Largest number of GPU keys that one replay may depend on: the width of the Jets.
inline constexpr int kJetWidth = 8;

class Predictor {
 public:
  /// Throws InputError M004 when a GPU has more than kJetWidth parameters.
  Predictor(const Experiment& experiment, int jobs);

  /// `log_values`: one for each parameter. The result does not depend on the number of threads.
  void evaluate(std::span<const double> log_values, bool gradients);

  /// Of the last evaluation; ms is 0 for cells that no replay predicts.
  const Prediction& operator[](std::size_t cell) const { return predictions_[cell]; }

  /// Start values of the experiment's parameters.
  std::vector<double> start() const;

 private:
  /// Replays share passes: those that several techniques begin with, those that no light reaches.
  struct SharedPass {
    const PassWork* work = nullptr;
    std::size_t gpu = 0;
    bool waits = false;
  };
  void collect_passes();
  template <class T>
  void evaluate_as(std::span<const double> log_values);

  const Experiment& experiment_;
  int jobs_;
  std::vector<SharedPass> passes_;
  std::vector<std::vector<std::size_t>> lit_, unlit_;  ///< by replay: indices into passes_
  std::vector<std::vector<std::size_t>> active_;       ///< by GPU: indices of the parameters of its keys
  std::vector<Prediction> predictions_;
};

/// Of a frame alone: time of the passes that `patterns` names, on a GPU whose calibrated keys have the values
/// of `gpu`; derivatives by ln(key).
Prediction predict_frame(const WorkTrace& trace, const GpuConfig& gpu, const std::vector<std::string>& keys);

}  // namespace hwsim::cost_models
