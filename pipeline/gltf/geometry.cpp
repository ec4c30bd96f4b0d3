#include "pipeline/gltf/geometry.h"

#include <algorithm>
#include <array>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>

#include "pipeline/gltf/accessor.h"
#include "pipeline/gltf/placement.h"
#include "pipeline/gltf/vertices.h"

namespace hwsim::pipeline::gltf {
namespace {

const tinygltf::Accessor& accessor_at(const tinygltf::Model& model, int index) {
  return model.accessors[static_cast<std::size_t>(index)];
}

int attribute(const tinygltf::Primitive& primitive, const char* name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? -1 : found->second;
}

// glTF 2.0 section 3.7.2.1: strips {i, i+1+i%2, i+2-i%2}, fans {i+1, i+2, 0}.
std::vector<std::uint32_t> triangle_list(std::vector<std::uint32_t> v, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    v.resize(v.size() / 3 * 3);
    return v;
  }
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i + 2 < v.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
      out.insert(out.end(), {v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
    else
      out.insert(out.end(), {v[i + 1], v[i + 2], v[0]});
  }
  return out;
}

std::span<float> floats_of(std::vector<float>& values) { return values; }
template <class T>
std::span<float> floats_of(std::vector<T>& vectors) {
  return {glm::value_ptr(vectors.front()), vectors.size() * sizeof(T) / sizeof(float)};
}

struct Needs {
  bool uv0 = false, uv1 = false, tangents = false;
  int tangent_uv_set = 0;
  UvSources uv_sources{};
};

Needs needs_of(const MaterialSet& set, std::size_t index) {
  const Material& material = set.materials[index];
  Needs needs;
  needs.uv_sources = set.uv_sources[index];
  for (const TextureRef* ref :
       {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
        &material.emissive_texture, &material.occlusion_texture}) {
    if (ref->texture < 0) continue;
    (ref->uv_set == 1 ? needs.uv1 : needs.uv0) = true;
  }
  needs.tangents = material.normal_texture.texture >= 0;
  needs.tangent_uv_set = material.normal_texture.uv_set;
  return needs;
}

/// The radius of wires. The name carries this program's mark: others write _RADIUS for something else.
constexpr const char* kRadiusAttribute = "_HWSIM_RADIUS";

class MeshBuilder {
 public:
  MeshBuilder(Report& report, const tinygltf::Model& model, const MaterialSet& materials, ViewRelease& views)
      : report_(report), model_(model), materials_(materials), views_(views) {}

  void add(const tinygltf::Primitive& primitive, const std::string& where, int material) {
    if (!draws_triangles(primitive, where)) return;
    refuse_compressed(primitive, where);
    if (attribute(primitive, "_RADIUS") >= 0)
      report_.note("S109", "_RADIUS is another program's attribute and is ignored: wires carry _HWSIM_RADIUS",
                   where);
    const Needs needs = needs_of(materials_, static_cast<std::size_t>(material));
    std::vector<std::uint32_t> indices = read_triangles(primitive, where);
    if (indices.empty())
      return report_.note("S105", "a primitive has no whole triangle and draws nothing", where);
    count_stored_bytes(primitive);
    const std::uint32_t base = attribute(primitive, "NORMAL") < 0
                                   ? add_flat(primitive, where, needs, indices)
                                   : add_shared(primitive, where, needs, indices);
    Mesh::Part part;
    part.first_index = static_cast<std::uint32_t>(mesh_.indices.size());
    part.index_count = static_cast<std::uint32_t>(indices.size());
    part.material = material;
    mesh_.parts.push_back(part);
    append_indices(std::move(indices), base);
  }

  BuiltMesh take() {
    mesh_.index_bytes = index_bytes_ ? index_bytes_ : 4;
    place_wire_surfaces();
    BuiltMesh out;
    out.local_from_mesh = bring_into_range();
    set_bounds();
    out.mesh = std::move(mesh_);
    return out;
  }

 private:
  bool draws_triangles(const tinygltf::Primitive& primitive, const std::string& where) {
    if (primitive.mode < 0 || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
      report_.fail("S004", where + ".mode is " + std::to_string(primitive.mode) + ", must be from 0 to 6");
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
      report_.note("S103", "points and lines are not drawn", where);
      return false;
    }
    if (attribute(primitive, "POSITION") >= 0) return true;
    report_.note("S104", "a primitive without positions draws nothing", where);
    return false;
  }

  // Compressed data leaves accessors without bytes: drawn, they would be one point.
  void refuse_compressed(const tinygltf::Primitive& primitive, const std::string& where) const {
    if (primitive.extensions.count("KHR_draco_mesh_compression") == 0) return;
    const tinygltf::Accessor& positions = accessor_at(model_, attribute(primitive, "POSITION"));
    if (positions.bufferView >= 0 || positions.sparse.isSparse) return;
    report_.fail("S006",
                 where +
                     " is compressed by KHR_draco_mesh_compression, which is not supported, and holds no "
                     "uncompressed data",
                 "export without Draco compression");
  }

  std::vector<std::uint32_t> read_triangles(const tinygltf::Primitive& primitive, const std::string& where) {
    const std::size_t vertex_count = accessor_at(model_, attribute(primitive, "POSITION")).count;
    std::vector<std::uint32_t> order;
    if (primitive.indices >= 0) {
      order = read_indices(report_, model_, primitive.indices, where + " indices");
      views_.copied(primitive.indices);
      const auto bad =
          std::find_if(order.begin(), order.end(), [&](std::uint32_t i) { return i >= vertex_count; });
      if (bad != order.end())
        report_.fail("S009", where + " indices: element " + std::to_string(bad - order.begin()) + " is " +
                                 std::to_string(*bad) + ", but there are " + std::to_string(vertex_count) +
                                 " vertices");
    } else {
      order.resize(vertex_count);
      for (std::size_t i = 0; i < vertex_count; ++i) order[i] = static_cast<std::uint32_t>(i);
    }
    if (primitive.mode == TINYGLTF_MODE_TRIANGLES && order.size() % 3 != 0)
      report_.note("S105", "indices after the last whole triangle are ignored", where);
    return triangle_list(std::move(order), primitive.mode);
  }

  // No normals: every triangle has vertices of its own.
  std::uint32_t add_flat(const tinygltf::Primitive& primitive, const std::string& where, const Needs& needs,
                         std::vector<std::uint32_t>& indices) {
    Vertices vertices = read_vertices(primitive, where, needs);
    split_flat(vertices, indices);
    report_.note("S106", "no normals: flat ones were generated, three vertices a triangle", where);
    finish_tangents(vertices, indices, where, needs);
    return append(std::move(vertices), where);
  }

  // Exporters often write one set of vertices for many primitives: it is kept once, unless tangents are
  // generated, which depend on the primitive's triangles; then each keeps a copy of the vertices that it
  // uses.
  std::uint32_t add_shared(const tinygltf::Primitive& primitive, const std::string& where, const Needs& needs,
                           std::vector<std::uint32_t>& indices) {
    const bool own_copy = needs.tangents && attribute(primitive, "TANGENT") < 0;
    std::string key = std::to_string(needs.uv0) + std::to_string(needs.uv1) + std::to_string(needs.tangents) +
                      needs.uv_sources.key();
    for (const auto& [name, accessor] : primitive.attributes)
      key += ' ' + name + ' ' + std::to_string(accessor);
    if (const auto found = base_of_.find(key); found != base_of_.end() && !own_copy) return found->second;
    Vertices vertices = read_vertices(primitive, where, needs);
    if (own_copy) keep_used(vertices, indices);
    if (const std::size_t wrong = repair_normals(vertices, indices); wrong > 0)
      report_.warn("S107", "normals that are not of unit length were normalized", where);
    finish_tangents(vertices, indices, where, needs);
    const std::uint32_t base = append(std::move(vertices), where);
    if (!own_copy) base_of_[key] = base;
    return base;
  }

  // The memory of a mesh's first primitive becomes the mesh's.
  void append_indices(std::vector<std::uint32_t> indices, std::uint32_t base) {
    for (std::uint32_t& index : indices) index += base;
    if (mesh_.indices.empty())
      mesh_.indices = std::move(indices);
    else
      mesh_.indices.insert(mesh_.indices.end(), indices.begin(), indices.end());
  }

  std::uint32_t append(Vertices vertices, const std::string& where) {
    const std::size_t base = mesh_.positions.size();
    if (base + vertices.positions.size() > std::numeric_limits<std::uint32_t>::max())
      report_.fail("S012", where + ": the mesh has more than 4294967295 vertices", "split the mesh");
    append_vertices(mesh_, std::move(vertices));
    return static_cast<std::uint32_t>(base);
  }

  // Colors and texture coordinates in integers are fractions of the largest one; some exporters forget the
  // flag, and none is known to mean anything else. Quantized meshes may have whole texture coordinates.
  bool must_be_normalized(int accessor, const std::string& name, const std::string& where) {
    const bool color = name == "COLOR_0", coordinates = name == "TEXCOORD_0" || name == "TEXCOORD_1";
    const tinygltf::Accessor& source = accessor_at(model_, accessor);
    if (!(color || coordinates) || source.normalized || source.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT)
      return source.normalized;
    const auto& used = model_.extensionsUsed;
    if (coordinates && std::find(used.begin(), used.end(), "KHR_mesh_quantization") != used.end())
      return false;
    report_.warn(
        "S121",
        std::string(color ? "colors" : "texture coordinates") +
            " in whole numbers lack the flag `normalized`: they are taken as fractions of the largest "
            "one, as exporters mean it",
        where + " attribute " + name);
    return true;
  }

  template <class T>
  std::vector<T> read_attribute(const tinygltf::Primitive& primitive, const char* name,
                                const std::string& where) {
    constexpr int kComponents = static_cast<int>(sizeof(T) / sizeof(float));
    const int accessor = attribute(primitive, name);
    if (accessor < 0) return {};
    const std::string place = where + " attribute " + name;
    const AccessorUse use{accessor, kComponents, place, must_be_normalized(accessor, name, where)};
    require_components(report_, model_, use);
    const std::size_t count = accessor_at(model_, accessor).count;
    const std::size_t wanted = accessor_at(model_, attribute(primitive, "POSITION")).count;
    if (count != wanted)
      report_.fail("S009", place + " has " + std::to_string(count) + " elements, POSITION has " +
                               std::to_string(wanted));
    std::vector<T> out(wanted);
    if (!out.empty()) read_floats(report_, model_, use, floats_of(out));
    return out;
  }

  std::vector<glm::vec4> read_colors(const tinygltf::Primitive& primitive, const std::string& where) {
    const int accessor = attribute(primitive, "COLOR_0");
    if (accessor < 0 || accessor_at(model_, accessor).type == TINYGLTF_TYPE_VEC4)
      return read_attribute<glm::vec4>(primitive, "COLOR_0", where);
    const auto rgb = read_attribute<glm::vec3>(primitive, "COLOR_0", where);
    std::vector<glm::vec4> out(rgb.size());
    std::transform(rgb.begin(), rgb.end(), out.begin(),
                   [](const glm::vec3& c) { return glm::vec4(c, 1.0f); });
    return out;
  }

  std::vector<glm::vec2> read_coordinates(const tinygltf::Primitive& primitive, const UvSource& source,
                                          const std::string& where) {
    auto out =
        read_attribute<glm::vec2>(primitive, source.file_set == 1 ? "TEXCOORD_1" : "TEXCOORD_0", where);
    if (source.transform == UvTransform{}) return out;
    for (glm::vec2& uv : out) uv = source.transform.applied(uv);
    return out;
  }

  void is_copied(const tinygltf::Primitive& primitive, const char* name) {
    if (const int accessor = attribute(primitive, name); accessor >= 0) views_.copied(accessor);
  }

  Vertices read_vertices(const tinygltf::Primitive& primitive, const std::string& where, const Needs& needs) {
    Vertices v;
    v.positions = read_attribute<glm::vec3>(primitive, "POSITION", where);
    is_copied(primitive, "POSITION");
    v.normals = read_attribute<glm::vec3>(primitive, "NORMAL", where);
    is_copied(primitive, "NORMAL");
    v.uv0 = read_coordinates(primitive, needs.uv_sources.sets[0], where);
    v.uv1 = read_coordinates(primitive, needs.uv_sources.sets[1], where);
    is_copied(primitive, "TEXCOORD_0");
    is_copied(primitive, "TEXCOORD_1");
    v.colors = read_colors(primitive, where);
    is_copied(primitive, "COLOR_0");
    v.radius = read_attribute<float>(primitive, kRadiusAttribute, where);
    if (needs.tangents || !v.radius.empty())
      v.tangents = read_attribute<glm::vec4>(primitive, "TANGENT", where);
    check_wire(v, where);
    for (auto& [uv, needed] : {std::pair{&v.uv0, needs.uv0}, std::pair{&v.uv1, needs.uv1}}) {
      if (!needed || !uv->empty()) continue;
      uv->assign(v.positions.size(), glm::vec2(0.0f));
      report_.note("S108", "a texture is used without texture coordinates: all were set to 0", where);
    }
    return v;
  }

  void check_wire(Vertices& v, const std::string& where) {
    if (v.radius.empty()) return;
    if (v.normals.empty() || v.tangents.empty()) {
      report_.warn("S109",
                   "_HWSIM_RADIUS is ignored: a wire needs NORMAL (outward) and TANGENT (along its axis)",
                   where);
      v.radius.clear();
      v.tangents.clear();
      return;
    }
    const auto bad = std::find_if(v.radius.begin(), v.radius.end(), [](float r) { return r < 0.0f; });
    if (bad != v.radius.end()) report_.fail("S010", where + " attribute _HWSIM_RADIUS has a negative value");
  }

  void finish_tangents(Vertices& v, const std::vector<std::uint32_t>& indices, const std::string& where,
                       const Needs& needs) {
    if (!v.tangents.empty()) {
      if (repair_tangents(v) > 0)
        report_.warn("S107", "tangents that are not of unit length were repaired", where);
    } else if (needs.tangents) {
      generate_tangents(v, indices, needs.tangent_uv_set);
      report_.note("S106", "no tangents: they were generated for the normal texture", where);
    }
  }

  void count_stored_bytes(const tinygltf::Primitive& primitive) {
    int bytes = 0;
    for (const char* name :
         {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0", kRadiusAttribute})
      if (const int accessor = attribute(primitive, name); accessor >= 0)
        bytes += element_bytes(model_, accessor);
    mesh_.vertex_bytes = std::max(mesh_.vertex_bytes, bytes);
    if (primitive.indices >= 0)
      index_bytes_ = std::max(index_bytes_, element_bytes(model_, primitive.indices));
  }

  // Far coordinates and far sizes cost precision, or leave it: the nodes' matrices take them over.
  glm::dmat4 bring_into_range() {
    const Placement placement = place_mesh(bounds_of(mesh_.positions));
    if (placement.is_identity()) return glm::dmat4(1.0);
    for (glm::vec3& p : mesh_.positions) p = glm::vec3((glm::dvec3(p) - placement.origin) * placement.scale);
    for (float& radius : mesh_.radius) radius = static_cast<float>(radius * placement.scale);
    return placement.inverse_matrix();
  }

  void set_bounds() {
    if (mesh_.positions.empty()) return;
    mesh_.bounds_min = mesh_.bounds_max = mesh_.positions.front();
    for (std::size_t i = 0; i < mesh_.positions.size(); ++i) {
      mesh_.bounds_min = glm::min(mesh_.bounds_min, mesh_.positions[i]);
      mesh_.bounds_max = glm::max(mesh_.bounds_max, mesh_.positions[i]);
    }
    for (Mesh::Part& part : mesh_.parts)
      for (std::uint32_t i = 0; i < part.index_count; i += 3 * kClusterTriangles)
        part.clusters.push_back(
            cluster_of(part.first_index + i, std::min(3 * kClusterTriangles, part.index_count - i)));
  }

  TriangleCluster cluster_of(std::uint32_t first_index, std::uint32_t count) const {
    TriangleCluster cluster;
    cluster.first_vertex = cluster.last_vertex = mesh_.indices[first_index];
    cluster.bounds_min = cluster.bounds_max = mesh_.positions[cluster.first_vertex];
    for (std::uint32_t i = first_index; i < first_index + count; ++i) {
      const std::uint32_t v = mesh_.indices[i];
      cluster.first_vertex = std::min(cluster.first_vertex, v);
      cluster.last_vertex = std::max(cluster.last_vertex, v);
      cluster.bounds_min = glm::min(cluster.bounds_min, mesh_.positions[v]);
      cluster.bounds_max = glm::max(cluster.bounds_max, mesh_.positions[v]);
    }
    return cluster;
  }

  /// Files hold a wire's center line (docs/techniques/wire.md); everything but wire anti-aliasing draws its
  /// surface.
  void place_wire_surfaces() {
    for (std::size_t i = 0; i < mesh_.radius.size(); ++i)
      mesh_.positions[i] += mesh_.normals[i] * mesh_.radius[i];
  }

  Report& report_;
  const tinygltf::Model& model_;
  const MaterialSet& materials_;
  ViewRelease& views_;
  Mesh mesh_;
  int index_bytes_ = 0;
  std::map<std::string, std::uint32_t> base_of_;
};

}  // namespace

BuiltMesh build_mesh(Report& report, const tinygltf::Model& model, int mesh_index,
                     const MaterialSet& materials, ViewRelease& views) {
  const auto place = static_cast<std::size_t>(mesh_index);
  const tinygltf::Mesh& source = model.meshes[place];
  MeshBuilder builder(report, model, materials, views);
  for (std::size_t i = 0; i < source.primitives.size(); ++i) {
    const tinygltf::Primitive& primitive = source.primitives[i];
    const std::string where = element("meshes", place) + "." + element("primitives", i);
    if (!primitive.targets.empty())
      report.note("S110", "morph targets are ignored: the base shape is drawn", where);
    const int default_material = static_cast<int>(model.materials.size());
    builder.add(primitive, where, primitive.material >= 0 ? primitive.material : default_material);
  }
  BuiltMesh built = builder.take();
  built.mesh.name = source.name.empty() ? element("meshes", place) : source.name;
  return built;
}

std::uint64_t triangle_count(const tinygltf::Model& model, int mesh) {
  std::uint64_t total = 0;
  for (const tinygltf::Primitive& primitive : model.meshes[static_cast<std::size_t>(mesh)].primitives)
    total += triangles_of(model, primitive);
  return total;
}

}  // namespace hwsim::pipeline::gltf
