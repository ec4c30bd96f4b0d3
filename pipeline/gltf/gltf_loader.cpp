#include "pipeline/gltf/gltf_loader.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <future>
#include <string>
#include <utility>

#include "pipeline/gltf/exposure.h"
#include "pipeline/gltf/extensions.h"
#include "pipeline/gltf/geometry.h"
#include "pipeline/gltf/materials.h"
#include "pipeline/gltf/nodes.h"
#include "pipeline/gltf/placement.h"
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

// A small file can draw a terabyte by instances.
void check_drawn_triangles(const Report& report, const tinygltf::Model& model,
                           const std::vector<PlacedNode>& nodes, std::uint64_t max_triangles) {
  std::vector<std::uint64_t> triangles(model.meshes.size(), 0);
  for (std::size_t m = 0; m < model.meshes.size(); ++m)
    triangles[m] = gltf::triangle_count(model, static_cast<int>(m));
  std::uint64_t drawn = 0;
  for (const PlacedNode& placed : nodes)
    if (const int mesh = node_at(model, placed).mesh; mesh >= 0)
      drawn += triangles[static_cast<std::size_t>(mesh)];
  if (drawn > max_triangles)
    report.fail("S012",
                "the scene draws " + std::to_string(drawn) + " triangles, the limit is " +
                    std::to_string(max_triangles),
                "draw fewer instances, or reduce the meshes");
}

// A mesh drawn by a node, in the file's coordinates.
struct DrawnMesh {
  int mesh = 0;
  glm::dmat4 file_from_mesh{1.0};
  std::string name;
};

// The scene's meshes for those of the file.
struct BuiltMeshes {
  std::vector<int> place;  ///< in Scene::meshes; -1: nothing is drawn
  std::vector<glm::dmat4> local_from_mesh;
};

BuiltMeshes build_meshes(Scene& scene, Report& report, gltf::Source& source,
                         const gltf::MaterialSet& materials, const std::vector<bool>& used) {
  const tinygltf::Model& model = source.model;
  BuiltMeshes out{std::vector<int>(model.meshes.size(), -1), std::vector<glm::dmat4>(model.meshes.size())};
  gltf::ViewRelease views(source);
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    if (!used[m]) {
      report.note("S116", "meshes that the scene does not use were not loaded", gltf::element("meshes", m));
      continue;
    }
    gltf::BuiltMesh built = gltf::build_mesh(report, model, static_cast<int>(m), materials, views);
    if (built.mesh.parts.empty()) continue;
    out.place[m] = static_cast<int>(scene.meshes.size());
    out.local_from_mesh[m] = built.local_from_mesh;
    scene.meshes.push_back(std::move(built.mesh));
  }
  return out;
}

std::vector<DrawnMesh> list_drawn(Report& report, const gltf::Source& source,
                                  const std::vector<PlacedNode>& nodes, const BuiltMeshes& meshes) {
  const std::vector<glm::dmat4> skins = gltf::skin_matrices(report, source, nodes);
  std::vector<DrawnMesh> drawn;
  for (const PlacedNode& placed : nodes) {
    const tinygltf::Node& node = node_at(source.model, placed);
    if (node.mesh < 0) continue;
    const auto mesh = static_cast<std::size_t>(node.mesh);
    if (meshes.place[mesh] < 0) continue;
    const std::string where = gltf::element("nodes", static_cast<std::size_t>(placed.node));
    // glTF 2.0 section 3.7.3.3: joints place a skinned mesh, its node's own transformation does not.
    const glm::dmat4& place =
        node.skin < 0 ? placed.world_from_local : skins[static_cast<std::size_t>(node.skin)];
    const glm::dmat4& local = meshes.local_from_mesh[mesh];
    drawn.push_back({meshes.place[mesh], local == glm::dmat4(1.0) ? place : place * local,
                     node.name.empty() ? where : node.name});
  }
  return drawn;
}

double largest_scale(const glm::dmat4& m) {
  return std::max(
      {glm::length(glm::dvec3(m[0])), glm::length(glm::dvec3(m[1])), glm::length(glm::dvec3(m[2]))});
}

// The scale that all meshes have: of the node above them, else their own, where it is the same for each and
// so far from 1 that it must be a unit's.
double shared_scale(const std::vector<DrawnMesh>& drawn, const tinygltf::Model& model,
                    const std::vector<PlacedNode>& nodes) {
  constexpr double kOrdinary = 16.0;
  const auto scale_of = [](const glm::dmat4& m) { return gltf::rounded_scale(largest_scale(m)); };
  const double above = scale_of(gltf::matrix_above_meshes(model, nodes));
  if (above > 0.0 && above != 1.0) return above;
  const double first = drawn.empty() ? 1.0 : scale_of(drawn.front().file_from_mesh);
  const bool same = std::all_of(drawn.begin(), drawn.end(),
                                [&](const DrawnMesh& d) { return scale_of(d.file_from_mesh) == first; });
  return same && first > 0.0 && (first < 1.0 / kOrdinary || first > kOrdinary) ? first : 1.0;
}

gltf::Placement choose_placement(const Report& report, const Scene& scene,
                                 const std::vector<DrawnMesh>& drawn, const tinygltf::Model& model,
                                 const std::vector<PlacedNode>& nodes) {
  constexpr double kMaxM = 1e18;
  gltf::Box bounds;
  double scale = 0.0, view_distance_m = 0.0;
  for (const DrawnMesh& d : drawn) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(d.mesh)];
    bounds.add({glm::dvec3(mesh.bounds_min), glm::dvec3(mesh.bounds_max)}, d.file_from_mesh);
    scale = std::max(scale, largest_scale(d.file_from_mesh));
    if (!bounds.empty() && !(glm::length(bounds.low) < 2 * kMaxM && glm::length(bounds.high) < 2 * kMaxM))
      report.fail("S010", d.name + " reaches farther than 1e18 m from the origin", "scale the scene down");
  }
  for (const PlacedNode& placed : nodes)
    if (node_at(model, placed).camera >= 0)
      view_distance_m =
          std::max(view_distance_m, glm::length(glm::dvec3(placed.world_from_local[3]) - bounds.center()));
  return gltf::place_scene(bounds, {shared_scale(drawn, model, nodes), scale}, view_distance_m);
}

// Whether what a float rounds of its place is seen on a mesh.
bool is_rounded_away(const Mesh& mesh, const glm::dmat4& matrix) {
  constexpr double kRounding = 0x1p-24, kSeen = 0.05;
  const glm::dvec3 half = 0.5 * (glm::dvec3(mesh.bounds_max) - glm::dvec3(mesh.bounds_min));
  const double size = 2.0 * glm::length(glm::dmat3(matrix) * half);
  return size > 0.0 && kRounding * glm::length(glm::dvec3(matrix[3])) > kSeen * size;
}

// Everything the file places, in the scene's own coordinates.
void place_everything(Scene& scene, Report& report, const gltf::Placement& placement,
                      const std::vector<DrawnMesh>& drawn, std::vector<PlacedNode>& nodes) {
  const bool as_is = placement.is_identity();
  const glm::dmat4 scene_from_file = placement.matrix();
  for (const DrawnMesh& d : drawn) {
    const glm::dmat4 matrix = as_is ? d.file_from_mesh : scene_from_file * d.file_from_mesh;
    // Squares stay inside a float's range. A mesh's own size was taken out: what is left is stretched.
    if (!(largest_scale(matrix) <= 1e18))
      report.fail("S010", d.name + " is stretched by more than 1e18", "scale the node down");
    scene.instances.push_back({d.mesh, glm::mat4(matrix), d.name});
    if (is_rounded_away(scene.meshes[static_cast<std::size_t>(d.mesh)], matrix))
      report.warn(
          "S120",
          "nodes lie so far apart that a float rounds their places by more than a twentieth of their size",
          d.name);
  }
  if (as_is) return;
  for (PlacedNode& placed : nodes) placed.world_from_local = scene_from_file * placed.world_from_local;
  scene.origin_m = placement.origin;
  scene.meters_per_unit = 1.0 / placement.scale;
  scene.units_per_option_m = placement.units_per_option_m;
  if (placement.within_range) return;
  report.note(
      "S120",
      "the scene lies or extends far beyond a float's precision: it was moved and scaled while loading "
      "(`hwsim scene check` says by how much)");
}

void expose(Scene& scene, Report& report, double exposure) {
  const SceneStats totals = stats(scene);
  const gltf::Box bounds{glm::dvec3(totals.bounds_min), glm::dvec3(totals.bounds_max)};
  scene.exposure = exposure > 0.0 ? exposure : gltf::automatic_exposure(scene.lights, bounds);
  if (scene.exposure == 1.0) return;
  for (Light& light : scene.lights) light.color *= static_cast<float>(scene.exposure);
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", scene.exposure);
  if (exposure > 0.0) return;
  report.note("S122", std::string("the lights are in photometric units: an exposure of ") + text +
                          " brings them to a picture's range (--exposure)");
}

void add_view_and_light(Scene& scene, Report& report, const gltf::Source& source,
                        const std::vector<PlacedNode>& nodes) {
  const tinygltf::Model& model = source.model;
  const SceneStats totals = stats(scene);
  const double units_per_m = 1.0 / scene.meters_per_unit;
  scene.lights = gltf::build_lights(report, model, nodes, units_per_m);
  if (scene.lights.empty()) {
    scene.lights.push_back(default_sun());
    report.note("S117", "the file has no lights: a white sun that casts shadows was added");
  }
  scene.cameras = gltf::build_cameras(report, model, source.cameras, nodes, units_per_m);
  for (Camera& camera : scene.cameras) {
    if (!(camera.far_m > 0.0f)) {
      camera.far_m = far_plane_m(camera, totals.bounds_min, totals.bounds_max);
      report.note("S118", "cameras without zfar got a far plane just behind the scene", camera.name);
    }
    if (depths_run_together(camera, totals.bounds_min, totals.bounds_max))
      report.warn("S123",
                  "a camera's near plane is so near that depths in the scene are one number: raise znear",
                  camera.name);
  }
  if (scene.cameras.empty()) {
    scene.cameras.push_back(framing_camera(totals.bounds_min, totals.bounds_max));
    report.note("S118", "the file has no camera: one that sees the whole scene was added");
  }
}

/// `container` is asked for once, and given back when its bytes have been read.
template <class ReadContainer>
Scene load(Report& report, ReadContainer&& container, const SceneLoadOptions& options) {
  gltf::Budget budget(report, options.max_memory_bytes);
  gltf::Source source = gltf::read_source(report, container(), options, budget);
  const tinygltf::Model& model = source.model;
  gltf::note_extensions(report, source);
  std::vector<PlacedNode> nodes = gltf::walk_scene(report, model);
  const std::vector<bool> used_meshes = meshes_in_use(model, nodes);
  check_drawn_triangles(report, model, nodes, options.max_drawn_triangles);
  gltf::charge_meshes(report, budget, model, used_meshes);

  Scene scene;
  scene.name = std::filesystem::path(report.file()).stem().string();
  gltf::MaterialSet set = gltf::build_materials(report, source, materials_in_use(model, used_meshes));
  scene.samplers = std::move(set.samplers);
  for (Sampler& sampler : scene.samplers)
    if (sampler.min == Filter::linear) sampler.max_anisotropy = std::clamp(options.max_anisotropy, 1, 16);
  gltf::charge_textures(report, budget, source, set.textures);
  // Beside the meshes: loading the image library alone takes 0.2 s.
  std::future<std::vector<Texture>> textures =
      std::async(std::launch::async, [&] { return gltf::build_textures(report, source, set.textures); });
  const std::vector<DrawnMesh> drawn =
      list_drawn(report, source, nodes, build_meshes(scene, report, source, set, used_meshes));
  scene.materials = std::move(set.materials);
  place_everything(scene, report, choose_placement(report, scene, drawn, model, nodes), drawn, nodes);
  add_view_and_light(scene, report, source, nodes);
  if (!options.alpha_test)
    for (Material& material : scene.materials)
      if (material.alpha_mode == AlphaMode::mask) material.alpha_mode = AlphaMode::opaque;
  expose(scene, report, options.exposure);
  scene.textures = textures.get();
  scene.memory_bytes = budget.charged_bytes();
  scene.content_hash = source.content_hash;
  if (options.exposure > 0.0) scene.content_hash += " exposed by " + std::to_string(options.exposure);
  scene.files = source.files;
  scene.notes = report.notes();
  return scene;
}

}  // namespace

Scene load_gltf(const std::string& path, const SceneLoadOptions& options) {
  Report report(path);
  return load(
      report, [&] { return gltf::read_container(report, options.max_file_bytes); }, options);
}

Scene load_glb(std::vector<std::uint8_t> bytes, const std::string& name, const SceneLoadOptions& options) {
  Report report(name);
  return load(
      report, [&] { return gltf::check_container(report, std::move(bytes), true); }, options);
}

}  // namespace hwsim::pipeline
