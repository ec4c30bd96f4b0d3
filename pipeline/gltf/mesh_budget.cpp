// What meshes take while they are loaded, told from counts before anything is read: a small file can announce
// a terabyte.
#include <algorithm>
#include <set>
#include <string>

#include "pipeline/gltf/geometry.h"

namespace hwsim::pipeline::gltf {
namespace {

bool has(const tinygltf::Primitive& primitive, const char* name) {
  return primitive.attributes.count(name) > 0;
}

std::uint64_t count_of(const tinygltf::Model& model, int accessor) {
  return accessor < 0 ? 0 : model.accessors[static_cast<std::size_t>(accessor)].count;
}

int position_accessor(const tinygltf::Primitive& primitive) {
  const auto found = primitive.attributes.find("POSITION");
  return found == primitive.attributes.end() ? -1 : found->second;
}

struct MeshSize {
  std::uint64_t vertices = 0, triangles = 0;  ///< as kept; vertices without normals count three a triangle
  std::uint64_t announced_vertices = 0;       ///< as the file counts them
  std::uint64_t largest_primitive = 0;        ///< elements of the largest primitive, which is held twice
};

MeshSize size_of(const tinygltf::Model& model, std::size_t mesh) {
  MeshSize size;
  std::set<int> shared;  // primitives that share their positions store them once
  for (const tinygltf::Primitive& primitive : model.meshes[mesh].primitives) {
    const std::uint64_t triangles = triangles_of(model, primitive);
    const std::uint64_t announced = count_of(model, position_accessor(primitive));
    const bool flat = !has(primitive, "NORMAL"), is_new = shared.insert(position_accessor(primitive)).second;
    size.triangles += triangles;
    size.announced_vertices += is_new ? announced : 0;
    size.vertices += flat ? 3 * triangles : is_new ? announced : 0;
    size.largest_primitive = std::max(size.largest_primitive, announced + 3 * triangles);
  }
  return size;
}

// Positions and normals always; the others where a primitive has them, for all of the mesh.
std::uint64_t vertex_bytes(const tinygltf::Mesh& mesh) {
  std::uint64_t bytes = 24;
  for (const auto& [name, size] : {std::pair{"TANGENT", 16}, std::pair{"TEXCOORD_0", 8},
                                   std::pair{"TEXCOORD_1", 8}, std::pair{"COLOR_0", 16}})
    if (std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                    [&, &attribute = name](const auto& p) { return has(p, attribute); }))
      bytes += static_cast<std::uint64_t>(size);
  return bytes;
}

}  // namespace

std::uint64_t triangles_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
  const int source = primitive.indices >= 0 ? primitive.indices : position_accessor(primitive);
  const std::uint64_t count = count_of(model, source);
  if (primitive.mode == TINYGLTF_MODE_TRIANGLES) return count / 3;
  const bool chained =
      primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP || primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
  return chained && count > 2 ? count - 2 : 0;
}

void charge_meshes(const Report& report, Budget& budget, const tinygltf::Model& model,
                   const std::vector<bool>& used_meshes) {
  // No honest file stores less than a byte for each vertex and triangle; a million are free, for meshes that
  // are sparse or all zeros.
  std::uint64_t allowed = std::uint64_t{1} << 20, triangles = 0, announced = 0, largest_bytes = 0;
  for (const tinygltf::Buffer& buffer : model.buffers) allowed += buffer.data.size();
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    if (!used_meshes[m]) continue;
    const MeshSize size = size_of(model, m);
    triangles += size.triangles;
    announced += size.announced_vertices;
    const std::uint64_t bytes = vertex_bytes(model.meshes[m]);
    largest_bytes = std::max(largest_bytes, size.largest_primitive * bytes);
    if (std::max(triangles, announced) > allowed)
      report.fail("S012",
                  "the meshes store " + std::to_string(triangles) + " triangles and " +
                      std::to_string(announced) + " vertices, far more than the file's bytes can describe",
                  "let several nodes refer to one mesh instead of copying it");
    budget.charge(size.vertices * bytes + size.triangles * 3 * sizeof(std::uint32_t), element("meshes", m));
  }
  budget.charge(largest_bytes, "the largest primitive");
}

}  // namespace hwsim::pipeline::gltf
