#pragma once
// Loads a glTF file as a scene.
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/scene/scene.h"

namespace hwsim::pipeline {

struct SceneLoadOptions {
  std::size_t max_file_bytes = std::size_t{4} << 30;
  std::uint64_t max_drawn_triangles = 200'000'000;
  /// A limit on all that loading takes: files, attributes, expanded strips, generated normals, textures with
  /// their mip chains.
  std::uint64_t max_memory_bytes = std::uint64_t{2} << 30;
  /// What the lights are multiplied by; 0: 1, or so much less that lights in photometric units (a sun of
  /// 100,000 lux) light white to about 1. Any other value becomes part of Scene::content_hash.
  double exposure = 0.0;
  /// Probes of a texture request at most, 1 to 16, along the longer axis of a pixel's footprint: of samplers
  /// that filter linearly. glTF has no word for it. No part of Scene::content_hash.
  int max_anisotropy = 1;
  /// Materials with an alpha test have it, or are opaque. No part of Scene::content_hash.
  bool alpha_test = true;
};

/// Reads a .gltf or .glb file. Throws InputError (codes S0xx) naming the file, the element
/// ("meshes[3].primitives[0] attribute POSITION") and the remedy; never returns a scene with an index out of
/// range or a value that is not finite.
Scene load_gltf(const std::string& path, const SceneLoadOptions& options = {});

/// The same of a GLB file's bytes; `name` stands for the file in messages.
Scene load_glb(std::vector<std::uint8_t> bytes, const std::string& name,
               const SceneLoadOptions& options = {});

}  // namespace hwsim::pipeline
