#include "pipeline/open/scene_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

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
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    const MipLevel& level = levels_of(scene, i).front();
    largest = std::max({largest, level.width, level.height});
  }
  return counted(scene.textures.size(), "texture") + ", largest side " + std::to_string(largest) + ", " +
         std::to_string(s.texture_bytes) + " bytes with mipmaps";
}

std::string meshes_line(const Scene& scene) {
  std::uint64_t wires = 0;
  for (const Mesh& mesh : scene.meshes) wires += !mesh.radius.empty();
  return counted(scene.meshes.size(), "mesh", "meshes") + " drawn by " +
         counted(scene.instances.size(), "node") + ", " + std::to_string(wires) +
         " with wires (_HWSIM_RADIUS)";
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string triple(const glm::dvec3& v, const char* between) {
  return number(v.x) + between + number(v.y) + between + number(v.z);
}

// In the file's own meters, wherever the scene was moved to.
std::string size_line(const Scene& scene, const SceneStats& s) {
  const glm::dvec3 low(s.bounds_min), high(s.bounds_max);
  std::string line = "size " + triple((high - low) * scene.meters_per_unit, " x ") +
                     " m (glTF's unit), center at (" +
                     triple((low + high) * 0.5 * scene.meters_per_unit + scene.origin_m, ", ") + ") m";
  if (scene.origin_m != glm::dvec3(0.0))
    line += "; moved by (" + triple(-scene.origin_m, ", ") + ") m while loading";
  if (scene.meters_per_unit != 1.0)
    line += "; a unit is " + number(scene.meters_per_unit) + " m while it is drawn";
  return line;
}

// The first few by name: a file may have thousands.
template <class Items, class Describe>
std::string listed(const Items& items, Describe describe) {
  constexpr std::size_t kShown = 8;
  std::string out;
  for (std::size_t i = 0; i < std::min(items.size(), kShown); ++i)
    out += (i == 0 ? ": " : ", ") + describe(items[i]);
  if (items.size() > kShown) out += " and " + std::to_string(items.size() - kShown) + " more";
  return out;
}

std::string cameras_line(const Scene& scene) {
  return counted(scene.cameras.size(), "camera") + listed(scene.cameras, [&](const Camera& camera) {
           return "`" + camera.name + "` (" +
                  (camera.orthographic
                       ? "orthographic, " +
                             number(2.0 * static_cast<double>(camera.ortho_half_height_m) *
                                    scene.meters_per_unit) +
                             " m high"
                       : number(static_cast<double>(camera.fov_y_rad) * 180.0 / 3.141592653589793) +
                             " degrees high") +
                  ")";
         });
}

std::string lights_line(const Scene& scene) {
  constexpr const char* kKinds[] = {"directional", "point", "spot"};
  std::string line = counted(scene.lights.size(), "light") + listed(scene.lights, [&](const Light& light) {
                       const double strength = std::max({light.color.x, light.color.y, light.color.z});
                       return "`" + light.name + "` (" + kKinds[static_cast<std::size_t>(light.kind)] + ", " +
                              number(strength) + (light.casts_shadow ? ", casts shadows)" : ")");
                     });
  const auto unshadowed = std::count_if(scene.lights.begin(), scene.lights.end(),
                                        [](const Light& light) { return !light.casts_shadow; });
  if (unshadowed > 0)
    line += "; " + std::to_string(unshadowed) + (unshadowed == 1 ? " casts no shadow" : " cast no shadow") +
            " (one directional light does)";
  if (scene.exposure != 1.0) line += "; exposed by " + number(scene.exposure);
  return line;
}

std::string cost_line(const Scene& scene, const SceneStats& s) {
  // An estimate for two cores, to tell seconds from minutes: the time grows with triangles and texels.
  const double seconds =
      1.0 + 2.5e-6 * static_cast<double>(s.drawn_triangles) + 3e-8 * static_cast<double>(s.texture_bytes);
  return "loading takes at most about " + std::to_string((scene.memory_bytes >> 20) + 1) +
         " MiB; loading and a first frame of 1280 x 720 take about " + number(std::ceil(seconds)) + " s";
}

}  // namespace

std::vector<Diagnostic> check_scene(const Scene& scene, const std::string& path) {
  const SceneStats totals = stats(scene);
  std::vector<Diagnostic> out;
  for (const std::string& line :
       {triangles_line(totals), size_line(scene, totals), meshes_line(scene), materials_line(scene),
        textures_line(scene, totals), cameras_line(scene), lights_line(scene), cost_line(scene, totals)}) {
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
}

}  // namespace hwsim::pipeline
