#pragma once
// One way to a scene: a file's path, or a generator's name with parameters ("grass:blades=20000,seed=3").
#include <functional>
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

using NoteFunction = std::function<void(const Diagnostic&)>;

/// Loads a file (a name that ends in .gltf or .glb), or generates a scene and loads it by the same loader.
/// Generated scenes are kept below `cache_directory` (created if missing; empty: nowhere), sealed; one that
/// is damaged is made anew, one that cannot be written is made the next time again: `note` hears of both
/// (K001, K002). Throws InputError with the nearest names.
Scene open_scene(const std::string& name_or_path, const std::string& cache_directory,
                 const SceneLoadOptions& options = {}, const NoteFunction& note = {});

/// The notes on a file of a cache: damaged, and made anew; and one that cannot be written.
Diagnostic damage_note(const std::string& path, const std::string& reason);
Diagnostic unwritable_note(const std::string& folder, const std::string& reason);

}  // namespace hwsim::pipeline
