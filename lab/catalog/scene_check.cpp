#include "lab/catalog/scene_check.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "algos/base/technique.h"
#include "hwsim/base/file_name.h"
#include "hwsim/base/units_of_measure.h"
#include "lab/base/scene_kinds.h"
#include "pipeline/open/scene_check.h"
#include "pipeline/open/scene_source.h"
#include "pipeline/reference/shadow_detail.h"

namespace hwsim::lab {
namespace {

std::vector<TableCell> scene_row(const pipeline::Scene& scene) {
  const pipeline::SceneStats s = pipeline::stats(scene);
  const glm::dvec3 size = glm::dvec3(s.bounds_max - s.bounds_min) * scene.meters_per_unit;
  return {scene.name,
          s.drawn_triangles,
          s.stored_triangles,
          s.vertices,
          std::uint64_t{scene.meshes.size()},
          std::uint64_t{scene.instances.size()},
          std::uint64_t{scene.materials.size() - 1},  // without the loader's own, which no file has
          std::uint64_t{scene.textures.size()},
          Real{static_cast<double>(s.texture_bytes) / kBytesPerMib, 1},
          s.drawn_mask_triangles,
          s.drawn_blend_triangles,
          std::uint64_t{scene.lights.size()},
          std::uint64_t{scene.cameras.size()},
          fmt::format("{:.3g} x {:.3g} x {:.3g}", size.x, size.y, size.z),
          std::uint64_t{scene.notes.size()}};
}

std::vector<Column> scene_columns() {
  return {{"scene", "scene"},
          {"drawn_triangles", "drawn triangles", true},
          {"stored_triangles", "stored triangles", true},
          {"vertices", "vertices", true},
          {"meshes", "meshes", true},
          {"instances", "instances", true},
          {"materials", "materials", true},
          {"textures", "textures", true},
          {"texture_mib", "texture MiB", true},
          {"drawn_mask_triangles", "alpha-tested triangles", true},
          {"drawn_blend_triangles", "blended triangles", true},
          {"lights", "lights", true},
          {"cameras", "cameras", true},
          {"size_m", "size, m", true},
          {"notes", "notes", true}};
}

bool is_file(const std::string& name) { return has_extension(name, ".gltf") || has_extension(name, ".glb"); }

/// Cameras from which shadows have steps of many pixels, in a frame as it is drawn by default.
void add_coarse_shadows(const std::string& name, const pipeline::Scene& scene, std::vector<Diagnostic>& all) {
  constexpr std::size_t kLookedThrough = 8;  // a file may have thousands
  const algos::FrameRequest frame;
  const auto details =
      pipeline::shadow_details(scene, kLookedThrough, frame.width_px, frame.height_px, frame.shadow_map_px);
  for (std::size_t i = 0; i < details.size(); ++i) {
    if (details[i].coarse_share < 0.01) continue;
    Diagnostic coarse;
    coarse.severity = Severity::warning;
    coarse.code = "S301";
    coarse.place.file = name;
    coarse.message = fmt::format(
        "a texel of the shadow map covers more than {:.0f} pixels in {:.0f} % of what camera `{}` sees at "
        "{} x {} (the median is {:.3g} pixels): shadows have steps of that size",
        pipeline::kCoarseTexelPx, 100.0 * details[i].coarse_share, scene.cameras[i].name, frame.width_px,
        frame.height_px, details[i].median_px);
    coarse.help = fmt::format("a larger map than {0} x {0}: --set scene.shadow_map_px=8192; or --no-shadows",
                              frame.shadow_map_px);
    all.push_back(std::move(coarse));
  }
}

/// What there is to say about a scene that loads; of a file, what it uses too.
std::vector<Diagnostic> findings(const std::string& name, const pipeline::Scene& scene) {
  std::vector<Diagnostic> all = is_file(name) ? pipeline::check_scene(scene, name) : scene.notes;
  add_coarse_shadows(name, scene, all);
  return all;
}

}  // namespace

CheckedScenes check_scenes(const std::vector<std::string>& names, const std::string& folder) {
  CheckedScenes checked{.table = {scene_columns(), {}}};
  for (const std::string& name : names) try {
      const pipeline::Scene scene = opened_scene(name, [&] { return pipeline::open_scene(name, folder); });
      std::vector<Diagnostic> notes = findings(name, scene);
      checked.table.rows.push_back(scene_row(scene));
      checked.notes.push_back(std::move(notes));
    } catch (const InputError& error) {
      checked.problems.insert(checked.problems.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
  return checked;
}

nlohmann::ordered_json to_json(const CheckedScenes& scenes) {
  nlohmann::ordered_json json = to_json(scenes.table);
  for (std::size_t i = 0; i < json.size(); ++i) {
    json[i]["notes"] = nlohmann::ordered_json::array();
    for (const Diagnostic& note : scenes.notes[i]) json[i]["notes"].push_back(note.message);
  }
  return json;
}

}  // namespace hwsim::lab
