#pragma once
// What `hwsim scene check` prints.
#include <string>
#include <vector>

#include "hwsim/base/diagnostics.h"

namespace hwsim::pipeline {

/// Loads the file and lists, in this order: the errors that keep it from loading (then nothing else), what it
/// uses (triangles, size and place, meshes, materials by alpha mode, textures, cameras and lights by name,
/// memory and seconds; severity note, code S300), what is not supported, and what was generated or repaired
/// (the loader's own notes). Never throws InputError.
std::vector<Diagnostic> check_gltf(const std::string& path);

}  // namespace hwsim::pipeline
