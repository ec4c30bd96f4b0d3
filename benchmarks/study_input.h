#pragma once
// What the studies and benchmarks of whole frames open the same way.
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "hwsim/gpu/gpu_config.h"
#include "pipeline/graph/frame_graph.h"
#include "pipeline/scene/scene.h"

namespace hwsim::benchmarks {

using ScenePointer = std::shared_ptr<const pipeline::Scene>;

/// The parts of a list between its commas.
std::vector<std::string> split_list(const std::string& list);

/// A generator's name with its parameters, or a glTF file. Throws InputError.
ScenePointer open_study_scene(const std::string& name);

/// The frame of a technique, shadow map included, for what the GPU has. Throws InputError.
pipeline::FrameGraph study_frame(const ScenePointer& scene, const std::string& technique,
                                 const GpuConfig& gpu, int width_px, int height_px);

double seconds_since(std::chrono::steady_clock::time_point start);

/// All problems of the input on standard error; the exit status that says so.
int report(const InputError& error);

}  // namespace hwsim::benchmarks
