#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "hwsim/base/file_name.h"
#include "lab/base/table.h"
#include "lab/store/cache.h"
#include "pipeline/open/scene_check.h"
#include "pipeline/open/scene_source.h"

namespace hwsim::cli {
namespace {

std::vector<Cell> scene_row(const pipeline::Scene& scene) {
  const pipeline::SceneStats s = pipeline::stats(scene);
  const glm::vec3 size = s.bounds_max - s.bounds_min;
  return {scene.name,
          s.drawn_triangles,
          s.stored_triangles,
          s.vertices,
          std::uint64_t{scene.meshes.size()},
          std::uint64_t{scene.instances.size()},
          std::uint64_t{scene.materials.size()},
          std::uint64_t{scene.textures.size()},
          Real{static_cast<double>(s.texture_bytes) / (1024.0 * 1024.0), 1},
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

/// One line a property reads better than one line a scene of fifteen columns.
Table transposed(const Table& table) {
  Table result{{{"property", "property"}}, {}};
  for (size_t row = 0; row < table.rows.size(); ++row)
    result.columns.push_back({fmt::format("scene_{}", row), "", true});
  for (size_t column = 0; column < table.columns.size(); ++column) {
    auto& line = result.rows.emplace_back();
    line.push_back(table.columns[column].title);
    for (const auto& row : table.rows) line.push_back(row[column]);
  }
  return result;
}

bool is_file(const std::string& name) { return has_extension(name, ".gltf") || has_extension(name, ".glb"); }

/// What there is to say about a scene that loads; of a file, what it uses too.
std::vector<Diagnostic> findings(const std::string& name, const pipeline::Scene& scene) {
  return is_file(name) ? pipeline::check_gltf(name) : scene.notes;
}

bool wants_lines(const CommonOptions& options) {
  return options.formats.empty() || options.formats.front().format == Format::table;
}

}  // namespace

ExitStatus scene_check(const SceneCheckOptions& options, Context& context) {
  Table table{scene_columns(), {}};
  nlohmann::ordered_json notes = nlohmann::ordered_json::array();
  std::vector<Diagnostic> problems;
  for (const std::string& name : options.scenes) try {
      const pipeline::Scene scene = pipeline::open_scene(name, cache_directory(CacheFolder::scenes));
      table.rows.push_back(scene_row(scene));
      auto& list = notes.emplace_back(nlohmann::ordered_json::array());
      for (const Diagnostic& note : findings(name, scene)) {
        list.push_back(note.message);
        context.log.report(note);
      }
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
  nlohmann::ordered_json json = to_json(table);
  for (size_t i = 0; i < json.size(); ++i) json[i]["notes"] = notes[i];
  if (!table.rows.empty())
    print({.table = wants_lines(options.common) ? transposed(table) : table, .json = &json}, options.common);
  if (!problems.empty()) throw InputError(problems);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
