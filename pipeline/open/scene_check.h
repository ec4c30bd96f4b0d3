#pragma once
// What `hwsim scene check` prints.
#include <string>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "pipeline/scene/scene.h"

namespace hwsim::pipeline {

/// Lists, in this order: what a scene that was loaded from the file uses (triangles, size and place, meshes,
/// materials by alpha mode, textures, cameras and lights by name, memory and seconds; severity note, code
/// S300), what is not supported, and what was generated or repaired (the loader's own notes).
std::vector<Diagnostic> check_scene(const Scene& scene, const std::string& path);

}  // namespace hwsim::pipeline
