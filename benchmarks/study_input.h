#pragma once
// What the studies and benchmarks of whole frames open the same way.
#include <chrono>
#include <string>
#include <vector>

#include "algos/techniques.h"
#include "hwsim/base/diagnostics.h"
#include "hwsim/gpu/gpu_config.h"
#include "lab/request/request.h"
#include "lab/store/cache.h"

namespace hwsim::benchmarks {

/// The parts of a list between its commas.
std::vector<std::string> split_list(const std::string& list);

/// The cache that the environment names.
lab::Cache study_cache();

/// The frame of a view, its scene loaded as `hwsim run` loads it. The caller sets what the GPU has. Throws
/// InputError.
algos::FrameRequest open_study(const lab::View& view);

/// The passes of a technique for that frame on a GPU. Throws InputError.
pipeline::FrameGraph study_frame(algos::FrameRequest request, const std::string& technique,
                                 const GpuConfig& gpu);

/// A GPU as documented, without calibration, with overlays of configs/overlays by name. Throws InputError.
GpuConfig study_gpu(const std::string& id, const std::vector<std::string>& overlays = {});

double seconds_since(std::chrono::steady_clock::time_point start);

/// All problems of the input on standard error; the exit status that says so.
int report(const InputError& error);

}  // namespace hwsim::benchmarks
