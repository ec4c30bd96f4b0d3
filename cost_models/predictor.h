#pragma once
// Times of all cells for a set of parameter values, with exact derivatives: the queue engine over Jets.
#include <span>
#include <vector>

#include "cost_models/experiment.h"
#include "hwsim/timing/traffic.h"

namespace hwsim::cost_models {

/// The prediction of one cell. Derivatives are those of ln(time) by ln(parameter), one for each parameter of
/// the experiment.
struct Prediction {
  double ms = 0.0;
  std::vector<double> gradient;
};

/// Largest number of GPU keys that one replay may depend on: the width of the Jets.
inline constexpr std::size_t kJetWidth = 8;

class Predictor {
 public:
  /// Predicts the cells that `wanted` marks, all of them when it is empty, and times no pass that none of
  /// them needs. Throws InputError M004 when a GPU has more than kJetWidth parameters.
  Predictor(const Experiment& experiment, int jobs, const std::vector<bool>& wanted = {});

  /// `log_values`: one for each parameter. The result does not depend on the number of threads.
  void evaluate(std::span<const double> log_values, bool gradients);

  /// Predictions of the last evaluation; ms is 0 for cells that no replay predicts, and for those that nobody
  /// wanted.
  const Prediction& operator[](std::size_t cell) const { return predictions_[cell]; }

  /// Start values of the experiment's parameters.
  std::vector<double> start() const;

 private:
  /// Replays share passes: those that several techniques begin with, those that no light reaches.
  struct SharedPass {
    const PassWork* work = nullptr;
    std::size_t gpu = 0;
    bool waits = false;
    PassShape shape;
  };
  /// A pass of a cell: indices into passes_. The second is the same pass without point lights, or the first
  /// again where the run has none.
  struct LitPass {
    std::size_t lit = 0, unlit = 0;
  };
  struct CellPasses {
    std::size_t cell = 0, replay = 0;
    bool presents = false;  ///< the row is a whole frame
    std::vector<LitPass> passes;
  };
  void collect_passes(const std::vector<bool>& wanted);
  template <class T>
  void evaluate_as(std::span<const double> log_values);
  template <class T, class Time>
  void predict(const CellPasses& of, const std::vector<Time>& times, std::span<const double> log_values);

  const Experiment& experiment_;
  int jobs_;
  std::vector<SharedPass> passes_;
  std::vector<CellPasses> cells_;
  std::vector<std::vector<std::size_t>> active_;  ///< by GPU: indices of the parameters of its keys
  std::vector<Prediction> predictions_;
};

}  // namespace hwsim::cost_models
