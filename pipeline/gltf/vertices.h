#pragma once
// The vertices of one primitive while it is being loaded.
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "pipeline/scene/scene.h"

namespace hwsim::pipeline::gltf {

/// Attributes are empty or have one entry a position.
struct Vertices {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents, colors;
  std::vector<glm::vec2> uv0, uv1;
  std::vector<float> radius;
};

/// Three new vertices a triangle with the face's normal, as glTF 2.0 demands where a file has no normals.
/// Tangents are dropped (glTF: to be ignored then); `indices` become 0, 1, 2, ...
void split_flat(Vertices& vertices, std::vector<std::uint32_t>& indices);

/// Drops the vertices that no index refers to; the others keep their order.
void keep_used(Vertices& vertices, std::vector<std::uint32_t>& indices);

/// Replaces normals of length zero by the mean of the faces around (or +y) and scales the others to length
/// one. Returns how many were not of unit length (more than 1 % off).
std::size_t repair_normals(Vertices& vertices, const std::vector<std::uint32_t>& indices);

/// Unit tangents perpendicular to the normals, w = +-1. Returns how many had to be replaced.
std::size_t repair_tangents(Vertices& vertices);

/// Tangents along +u, averaged over the triangles at a vertex weighted by the corner's angle, as in
/// MikkTSpace, but without splitting vertices: where u is mirrored across a shared vertex the larger side's
/// handedness wins.
void generate_tangents(Vertices& vertices, const std::vector<std::uint32_t>& indices, int uv_set);

/// Appends to a mesh; an attribute that only one side has is filled with its neutral value on the other.
void append_vertices(Mesh& mesh, Vertices vertices);

}  // namespace hwsim::pipeline::gltf
