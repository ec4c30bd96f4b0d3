#pragma once
// One way to a scene: a file's path, or a generator's name with parameters ("grass:blades=20000,seed=3").
#include <map>
#include <span>
#include <string>

#include "pipeline/generate/generator_info.h"
#include "pipeline/gltf/gltf_loader.h"
#include "pipeline/scene/scene.h"

namespace hwsim::pipeline {

std::span<const GeneratorInfo> generators();

/// Writes the generated scene as GLB (the bytes are a function of name and parameters alone).
/// Throws InputError for an unknown name or parameter and for a value outside its range.
void write_generated_scene(const std::string& name, const std::map<std::string, double>& parameters,
                           const std::string& path);

/// Loads a file (a name that ends in .gltf or .glb), or generates a scene, writes it below `cache_directory`
/// (created if missing, files replaced atomically) and loads it by the same loader. Throws InputError with
/// the nearest names.
Scene open_scene(const std::string& name_or_path, const std::string& cache_directory,
                 const SceneLoadOptions& options = {});

}  // namespace hwsim::pipeline
