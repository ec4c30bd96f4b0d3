#pragma once
// Loads a glTF file as a scene.
#include <string>

#include "pipeline/scene/scene.h"

namespace hwsim::pipeline {

struct SceneLoadOptions {
  std::size_t max_file_bytes = std::size_t{4} << 30;
  std::uint64_t max_drawn_triangles = 200'000'000;
};

/// Reads a .gltf or .glb file. Throws InputError (codes S0xx) naming the file, the element
/// ("meshes[3].primitives[0] attribute POSITION") and the remedy; never returns a scene with an index out of
/// range or a value that is not finite.
Scene load_gltf(const std::string& path, const SceneLoadOptions& options = {});

}  // namespace hwsim::pipeline
