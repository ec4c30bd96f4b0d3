#include "pipeline/gltf/gltf_loader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <future>
#include <set>
#include <string>
#include <utility>

#include "pipeline/gltf/extensions.h"
#include "pipeline/gltf/geometry.h"
#include "pipeline/gltf/materials.h"
#include "pipeline/gltf/nodes.h"
#include "pipeline/gltf/source.h"
#include "pipeline/scene/framing.h"

namespace hwsim::pipeline {
namespace {
using gltf::PlacedNode;
using gltf::Report;

const tinygltf::Node& node_at(const tinygltf::Model& model, const PlacedNode& placed) {
  return model.nodes[static_cast<std::size_t>(placed.node)];
}

std::vector<bool> meshes_in_use(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes) {
  std::vector<bool> used(model.meshes.size(), false);
  for (const PlacedNode& placed : nodes)
    if (const int mesh = node_at(model, placed).mesh; mesh >= 0) used[static_cast<std::size_t>(mesh)] = true;
  return used;
}

std::vector<bool> materials_in_use(const tinygltf::Model& model, const std::vector<bool>& used_meshes) {
  std::vector<bool> used(model.materials.size(), false);
  for (std::size_t m = 0; m < model.meshes.size(); ++m)
    for (const tinygltf::Primitive& primitive : model.meshes[m].primitives)
      if (used_meshes[m] && primitive.material >= 0)
        used[static_cast<std::size_t>(primitive.material)] = true;
  return used;
}

// Primitives of a mesh that share their positions store them once.
std::uint64_t stored_vertices(const tinygltf::Model& model, const tinygltf::Mesh& mesh) {
  std::set<int> accessors;
  for (const tinygltf::Primitive& primitive : mesh.primitives)
    if (const auto p = primitive.attributes.find("POSITION"); p != primitive.attributes.end())
      accessors.insert(p->second);
  std::uint64_t count = 0;
  for (const int accessor : accessors) count += model.accessors[static_cast<std::size_t>(accessor)].count;
  return count;
}

// Counts alone, before any vertex is read: a small file can ask for a terabyte, by instances (bounded by the
// caller's limit) or by many meshes over the same bytes (bounded here: no honest file stores less than a byte
// for each).
void check_budget(const Report& report, const tinygltf::Model& model, const std::vector<PlacedNode>& nodes,
                  const std::vector<bool>& used_meshes, std::uint64_t max_triangles) {
  constexpr std::uint64_t kFreeElements = std::uint64_t{1} << 25;
  std::uint64_t allowed = kFreeElements, triangles_stored = 0, vertices = 0, drawn = 0;
  for (const tinygltf::Buffer& buffer : model.buffers) allowed += buffer.data.size();
  std::vector<std::uint64_t> triangles(model.meshes.size(), 0);
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    if (!used_meshes[m]) continue;
    triangles[m] = gltf::triangle_count(model, static_cast<int>(m));
    triangles_stored += triangles[m];
    vertices += stored_vertices(model, model.meshes[m]);
  }
  for (const PlacedNode& placed : nodes)
    if (const int mesh = node_at(model, placed).mesh; mesh >= 0)
      drawn += triangles[static_cast<std::size_t>(mesh)];
  if (drawn > max_triangles)
    report.fail("S012",
                "the scene draws " + std::to_string(drawn) + " triangles, the limit is " +
                    std::to_string(max_triangles),
                "draw fewer instances, or reduce the meshes");
  if (std::max(triangles_stored, vertices) > allowed)
    report.fail("S012",
                "the meshes store " + std::to_string(triangles_stored) + " triangles and " +
                    std::to_string(vertices) + " vertices, far more than the file's bytes can describe",
                "let several nodes refer to one mesh instead of copying it");
}

void add_meshes(Scene& scene, Report& report, const tinygltf::Model& model,
                const std::vector<PlacedNode>& nodes, const std::vector<bool>& used) {
  std::vector<int> place(model.meshes.size(), -1);
  const int default_material = static_cast<int>(model.materials.size());
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    if (!used[m]) {
      report.note("S116", "meshes that the scene does not use were not loaded", gltf::element("meshes", m));
      continue;
    }
    Mesh mesh = gltf::build_mesh(report, model, static_cast<int>(m), scene.materials, default_material);
    if (mesh.parts.empty()) continue;
    place[m] = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
  }
  for (const PlacedNode& placed : nodes) {
    const tinygltf::Node& node = node_at(model, placed);
    if (node.mesh < 0 || place[static_cast<std::size_t>(node.mesh)] < 0) continue;
    const std::string where = gltf::element("nodes", static_cast<std::size_t>(placed.node));
    if (node.skin >= 0)
      report.note("S110", "skins are ignored: meshes are drawn as modeled, placed by their node", where);
    scene.instances.push_back({place[static_cast<std::size_t>(node.mesh)], glm::mat4(placed.world_from_local),
                               node.name.empty() ? where : node.name});
  }
}

void check_world_bounds(const Report& report, const SceneStats& totals) {
  constexpr float kMax = 1e18f;  // squares stay inside float's range
  for (int i = 0; i < 3; ++i)
    if (!(std::abs(totals.bounds_min[i]) <= kMax) || !(std::abs(totals.bounds_max[i]) <= kMax))
      report.fail("S010", "the scene reaches farther than 1e18 m from the origin", "scale the scene down");
}

void add_view_and_light(Scene& scene, Report& report, const tinygltf::Model& model,
                        const std::vector<PlacedNode>& nodes) {
  const SceneStats totals = stats(scene);
  check_world_bounds(report, totals);
  scene.lights = gltf::build_lights(report, model, nodes);
  if (scene.lights.empty()) {
    scene.lights.push_back(default_sun());
    report.note("S117", "the file has no lights: a white sun that casts shadows was added");
  }
  scene.cameras = gltf::build_cameras(report, model, nodes);
  for (Camera& camera : scene.cameras) {
    if (camera.far_m > 0.0f) continue;
    camera.far_m = far_plane_m(camera, totals.bounds_min, totals.bounds_max);
    report.note("S118", "cameras without zfar got a far plane just behind the scene", camera.name);
  }
  if (scene.cameras.empty()) {
    scene.cameras.push_back(framing_camera(totals.bounds_min, totals.bounds_max));
    report.note("S118", "the file has no camera: one that sees the whole scene was added");
  }
}

}  // namespace

Scene load_gltf(const std::string& path, const SceneLoadOptions& options) {
  Report report(path);
  gltf::Source source = gltf::read_source(report, options);
  const tinygltf::Model& model = source.model;
  gltf::note_extensions(report, model);
  const std::vector<PlacedNode> nodes = gltf::walk_scene(report, model);
  const std::vector<bool> used_meshes = meshes_in_use(model, nodes);
  check_budget(report, model, nodes, used_meshes, options.max_drawn_triangles);

  Scene scene;
  scene.name = std::filesystem::path(path).stem().string();
  gltf::MaterialSet set = gltf::build_materials(report, model, materials_in_use(model, used_meshes));
  scene.materials = std::move(set.materials);
  scene.samplers = std::move(set.samplers);
  // Beside the meshes: loading the image library alone takes 0.2 s.
  std::future<std::vector<Texture>> textures =
      std::async(std::launch::async, [&] { return gltf::build_textures(report, source, set.textures); });
  add_meshes(scene, report, model, nodes, used_meshes);
  add_view_and_light(scene, report, model, nodes);
  scene.textures = textures.get();
  scene.content_hash = source.content_hash;
  scene.files = source.files;
  scene.notes = report.notes();
  return scene;
}

}  // namespace hwsim::pipeline
