#pragma once
// configs/calibrated: where `run` and `reproduce` find what `fit` wrote.
#include <optional>
#include <string>

#include "cost_models/calibration.h"

namespace hwsim::lab {

/// config_directory()/calibrated/calibration.json; none when nothing was fitted yet. Throws InputError M006.
std::optional<cost_models::Calibration> load_calibration();

/// The calibrated file of a GPU, or its documented one.
std::string gpu_file(const std::string& name);

/// Support and 90 % interval of a frame, from the calibration beside the GPU files.
void add_interval(FrameTiming& timing, const WorkTrace& trace, const GpuConfig& gpu,
                  const std::string& technique);

}  // namespace hwsim::lab
