#pragma once
// Meshes of a glTF file as triangles.
#include <vector>

#include "pipeline/gltf/source.h"
#include "pipeline/scene/scene.h"

namespace hwsim::pipeline::gltf {

/// The mesh as triangles; a glTF primitive without a material gets `default_material`. `materials` says which
/// UV sets and tangents the vertices need. Throws InputError (S004, S009, S010).
Mesh build_mesh(Report& report, const tinygltf::Model& model, int mesh,
                const std::vector<Material>& materials, int default_material);

/// Triangles that a glTF mesh draws, from the counts alone.
std::uint64_t triangle_count(const tinygltf::Model& model, int mesh);

}  // namespace hwsim::pipeline::gltf
