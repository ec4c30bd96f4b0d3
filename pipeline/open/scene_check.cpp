#include "pipeline/open/scene_check.h"

#include <algorithm>
#include <utility>

#include "pipeline/gltf/gltf_loader.h"

namespace hwsim::pipeline {
namespace {

std::string counted(std::uint64_t count, const std::string& name, const std::string& plural = "") {
  return std::to_string(count) + " " + (count == 1 ? name : plural.empty() ? name + "s" : plural);
}

std::string triangles_line(const SceneStats& s) {
  return counted(s.drawn_triangles, "triangle") + " drawn (" + std::to_string(s.drawn_mask_triangles) +
         " alpha-tested, " + std::to_string(s.drawn_blend_triangles) + " blended), " +
         std::to_string(s.stored_triangles) + " stored, " + counted(s.vertices, "vertex", "vertices");
}

std::string materials_line(const Scene& scene) {
  std::uint64_t masked = 0, blended = 0, double_sided = 0, normal_mapped = 0, unlit = 0;
  for (const Material& m : scene.materials) {
    masked += m.alpha_mode == AlphaMode::mask;
    blended += m.alpha_mode == AlphaMode::blend;
    double_sided += m.double_sided;
    normal_mapped += m.normal_texture.texture >= 0;
    unlit += m.model == ShadingModel::unlit;
  }
  // The last one is the loader's default material, which the file does not have.
  return counted(scene.materials.size() - 1, "material") + ": " + std::to_string(masked) + " alpha-tested, " +
         std::to_string(blended) + " blended, " + std::to_string(double_sided) + " double-sided, " +
         std::to_string(normal_mapped) + " with a normal texture, " + std::to_string(unlit) + " unlit";
}

std::string textures_line(const Scene& scene, const SceneStats& s) {
  int largest = 0;
  for (const Texture& texture : scene.textures)
    largest = std::max({largest, texture.levels.front().width, texture.levels.front().height});
  return counted(scene.textures.size(), "texture") + ", largest side " + std::to_string(largest) + ", " +
         std::to_string(s.texture_bytes) + " bytes with mipmaps";
}

std::string meshes_line(const Scene& scene) {
  std::uint64_t wires = 0;
  for (const Mesh& mesh : scene.meshes) wires += !mesh.radius.empty();
  return counted(scene.meshes.size(), "mesh", "meshes") + " drawn by " +
         counted(scene.instances.size(), "node") + ", " + std::to_string(wires) + " with wires (_RADIUS)";
}

std::string lights_line(const Scene& scene) {
  std::uint64_t kinds[3] = {};
  for (const Light& light : scene.lights) ++kinds[static_cast<std::size_t>(light.kind)];
  return counted(scene.lights.size(), "light") + " (" + std::to_string(kinds[0]) + " directional, " +
         std::to_string(kinds[1]) + " point, " + std::to_string(kinds[2]) + " spot), " +
         counted(scene.cameras.size(), "camera");
}

}  // namespace

std::vector<Diagnostic> check_gltf(const std::string& path) {
  try {
    const Scene scene = load_gltf(path);
    const SceneStats totals = stats(scene);
    std::vector<Diagnostic> out;
    for (const std::string& line : {triangles_line(totals), meshes_line(scene), materials_line(scene),
                                    textures_line(scene, totals), lights_line(scene)}) {
      Diagnostic d;
      d.severity = Severity::note;
      d.code = "S300";
      d.message = line;
      d.place.file = path;
      out.push_back(std::move(d));
    }
    // What is not drawn as the author meant comes before what was merely filled in.
    std::vector<Diagnostic> notes = scene.notes;
    const auto is_loss = [](const Diagnostic& d) {
      return d.code == "S101" || d.severity == Severity::warning;
    };
    std::stable_partition(notes.begin(), notes.end(), is_loss);
    out.insert(out.end(), notes.begin(), notes.end());
    return out;
  } catch (const InputError& e) {
    return e.diagnostics();
  }
}

}  // namespace hwsim::pipeline
