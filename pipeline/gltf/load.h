#pragma once
// Loading, with what only `hwsim scene check` wants to know.
#include <string>
#include <vector>

#include "pipeline/gltf/gltf_loader.h"

namespace hwsim::pipeline::gltf {

/// As load_gltf. `light_names` (optional) receives the names of the file's lights, in the scene's order.
Scene load_scene(const std::string& path, const SceneLoadOptions& options,
                 std::vector<std::string>* light_names);

}  // namespace hwsim::pipeline::gltf
