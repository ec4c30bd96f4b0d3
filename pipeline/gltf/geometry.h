#pragma once
// The primitives of a glTF mesh as one list of triangles.
#include <vector>

#include "pipeline/gltf/materials.h"
#include "pipeline/gltf/source.h"
#include "pipeline/gltf/view_release.h"
#include "pipeline/scene/scene.h"

namespace hwsim::pipeline::gltf {

struct BuiltMesh {
  Mesh mesh;
  glm::dmat4 local_from_mesh{1.0};  ///< to the file's coordinates; the identity unless those are out of range
};

/// The mesh as triangles; a glTF primitive without a material gets the one behind the file's. `materials`
/// says which UV sets and tangents the vertices need. `views` gives back what has been copied: each mesh is
/// built once. Throws InputError (S004, S006, S009, S010).
BuiltMesh build_mesh(Report& report, const tinygltf::Model& model, int mesh, const MaterialSet& materials,
                     ViewRelease& views);

/// Triangles that a primitive, or all of a glTF mesh, draws, from the counts alone.
std::uint64_t triangles_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive);
std::uint64_t triangle_count(const tinygltf::Model& model, int mesh);

/// Charges what the meshes in use will take while they are loaded, from the counts alone; also refuses counts
/// that the file's bytes cannot hold. Throws InputError (S012).
void charge_meshes(const Report& report, Budget& budget, const tinygltf::Model& model,
                   const std::vector<bool>& used_meshes);

}  // namespace hwsim::pipeline::gltf
