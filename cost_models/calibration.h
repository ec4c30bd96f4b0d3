#pragma once
// What a fit leaves behind: configs/calibrated/GPU.toml, which hold the fitted values and take the rest from
// configs/gpus/GPU.toml, and calibration.json beside them, from which `run` takes intervals and `reproduce`
// predictions.
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cost_models/validation.h"

namespace hwsim::cost_models {

struct CalibratedParameter {
  Scope scope = Scope::gpu;
  std::string member, name, unit;
  double start = 0.0, low = 0.0, high = 0.0;  ///< declared
  double value = 0.0, low90 = 0.0, high90 = 0.0;
  bool used = false, at_bound = false, identified = true, credible = true;
};

struct Calibration {
  int version = 1;
  std::vector<CalibratedParameter> parameters;
  std::vector<double> covariance;  ///< covariance of the logarithms, row by row
  double residual_log_sd = 0.0;
  std::map<std::string, double> quantile90;                 ///< by split
  double ratio_log_sd = 0.0;                                ///< as Validation has it
  std::map<std::string, double> ratio_quantile90;           ///< by split
  std::map<std::string, std::set<std::string>> techniques;  ///< by GPU: those with fitted rows, "agaa:c=4"
  std::map<std::string, double> held_out_ms;                ///< by row: by the fit that did not see its scene
  std::set<std::string> gpu_keys;                           ///< that GPUs had when they were fitted
  std::map<std::string, std::string> gpu_hashes;  ///< for each calibrated GPU the hash of the values of these
};

Calibration make_calibration(const Experiment& experiment, const Validation& validation);

/// The GPU with its fitted values; each says that it is fitted, and its interval.
GpuConfig calibrated_gpu(const GpuConfig& documented, const Calibration& calibration);

/// Its file: the fitted keys alone. It has the id of the documented GPU, and extends it.
std::string calibrated_file(const GpuConfig& documented, const Calibration& calibration);

std::string to_json(const Calibration& calibration);
/// Throws InputError M006 for a damaged file.
Calibration calibration_from_json(const std::string& text, const std::string& path);

/// The fit that a calibration holds, for the same parameters; none when they were declared differently.
std::optional<Fit> fit_of(const Calibration& calibration, const std::vector<FittedParameter>& parameters);

/// Whether the parameter is the GPU's: a GPU's own takes the place of the one for all.
bool concerns(const Calibration& calibration, const CalibratedParameter& parameter, const std::string& gpu);

}  // namespace hwsim::cost_models
