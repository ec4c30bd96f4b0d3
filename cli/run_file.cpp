#include "cli/run_file.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <filesystem>
#include <optional>
#include <sstream>

#include "cli/files.h"
#include "cli/help_texts.h"
#include "cli/image_input.h"
#include "cli/messages.h"

namespace hwsim::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kSchema = 1;

/// Takes the keys of a file one by one; what is left over at the end nobody knows.
class Reader {
 public:
  Reader(toml::table& table, std::string path, const std::string& text)
      : table_(table), path_(std::move(path)) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) lines_.push_back(line);
  }

  template <class T>
  void take(const std::string& key, T& target, const char* expected) {
    known_.push_back(key);
    const toml::node* node = table_.get(key);
    if (!node) return;
    if (const std::optional<T> value = node->value_exact<T>())
      target = *value;
    else
      add("C013", "`" + key + "` must be " + expected, node->source());
  }

  void take_count(const std::string& key, int& target, int low, int high) {
    std::int64_t value = target;
    take(key, value, "a whole number");
    if (value < low || value > high)
      add("C014", fmt::format("`{}` is {}, must be between {} and {}", key, value, low, high),
          table_.get(key)->source());
    else
      target = static_cast<int>(value);
  }

  void finish() {
    for (const auto& [key, node] : table_) {
      const std::string name(key.str());
      if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
      add("C012", "unknown key `" + name + "` in a run file", key.source(), did_you_mean(name, known_),
          static_cast<int>(name.size()));
    }
    if (!problems_.empty()) throw InputError(problems_);
  }

  void add(const std::string& code, const std::string& message, const toml::source_region& where,
           const std::string& hint = {}, int length = 1) {
    SourcePlace place{path_, static_cast<int>(where.begin.line), static_cast<int>(where.begin.column), length,
                      ""};
    if (place.line > 0 && static_cast<size_t>(place.line) <= lines_.size())
      place.line_text = lines_[static_cast<size_t>(place.line) - 1];
    Diagnostic d = problem(code, message, hint);
    d.place = place;
    problems_.push_back(std::move(d));
  }

 private:
  toml::table& table_;
  std::string path_;
  std::vector<std::string> lines_, known_;
  std::vector<Diagnostic> problems_;
};

toml::table parse(const std::string& text, const std::string& path) {
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    const auto& where = error.source().begin;
    Diagnostic d = problem("C011", "not TOML: " + std::string(error.description()));
    d.place = {path, static_cast<int>(where.line), static_cast<int>(where.column), 1, ""};
    throw InputError(d);
  }
}

/// A path in a file is relative to that file; names of generators and GPUs are no paths.
std::string resolve(const std::string& name, const std::string& file,
                    std::initializer_list<const char*> endings) {
  for (const char* ending : endings)
    if (name.ends_with(ending)) return (fs::path(file).parent_path() / name).lexically_normal().string();
  return name;
}

void check_kind(Reader& reader, const toml::table& table) {
  std::int64_t schema = kSchema;
  std::string kind = "(missing)";
  reader.take("schema", schema, "a whole number");
  reader.take("kind", kind, "text");
  const auto where = [&](const char* key) {
    return table.get(key) ? table.get(key)->source() : table.source();
  };
  if (schema != kSchema)
    reader.add("C019", fmt::format("schema is {}, this program reads {}", schema, kSchema), where("schema"));
  if (kind != "run") reader.add("C019", "kind is `" + kind + "`, must be `run`", where("kind"));
}

std::string quoted(const std::string& text) { return to_toml(TomlValue(text)); }

}  // namespace

RunFile read_run_file(const std::string& path) {
  const std::string text = read_file(path);
  toml::table table = parse(text, path);
  Reader reader(table, path, text);
  RunFile file;
  check_kind(reader, table);
  reader.take("scene", file.view.scene, "text");
  reader.take("technique", file.technique, "text");
  reader.take("gpu", file.gpu, "text");
  reader.take("engine", file.engine, "text");
  reader.take("detailed_sample", file.detailed_sample, "number");
  if (!(file.detailed_sample >= 1e-3 && file.detailed_sample <= 1.0))
    reader.add("C014",
               fmt::format("`detailed_sample` is {}, must be between 0.001 and 1", file.detailed_sample),
               table.source());
  reader.take("camera", file.view.camera, "text");
  reader.take("emulator_skip", file.skip, "text");
  reader.take("shadows", file.view.shadows, "true or false");
  reader.take_count("width_px", file.view.resolution.width_px, 1, kMaxSidePx);
  reader.take_count("height_px", file.view.resolution.height_px, 1, kMaxSidePx);
  reader.take_count("shadow_map_px", file.view.shadow_map_px, 16, kMaxSidePx);
  reader.take_count("point_lights", file.view.point_lights, 0, 1024);
  reader.take("light_range", file.view.light_range, "number");
  if (!(file.view.light_range >= 1e-3 && file.view.light_range <= 100.0))
    reader.add("C014",
               fmt::format("`light_range` is {}, must be between 0.001 and 100", file.view.light_range),
               table.source());
  std::string lights = "scene";
  reader.take("lights", lights, "text");
  if (const auto profile = light_profile_from_name(lights))
    file.view.lights = *profile;
  else
    reader.add("C019", "lights is `" + lights + "`, must be scene, simple or complex",
               table.get("lights") ? table.get("lights")->source() : table.source());
  reader.take_count("reference_samples", file.reference_samples, 0, 65536);
  if (file.view.scene.empty()) reader.add("C015", "`scene` is missing", table.source());
  reader.finish();
  file.view.scene = is_image_file(file.view.scene) ? resolve(file.view.scene, path, {""})
                                                   : resolve(file.view.scene, path, {".gltf", ".glb"});
  file.gpu = resolve(file.gpu, path, {".toml"});
  return file;
}

std::string skip_text(const pipeline::SkipSwitches& skip) {
  std::string names;
  std::size_t count = 0;
  for (const pipeline::SkipInfo& info : pipeline::kSkips) {
    if (!(skip.*info.flag)) continue;
    names += (count++ == 0 ? "" : ",") + std::string(info.name);
  }
  if (count == pipeline::kSkips.size()) return "all";
  return count == 0 ? "none" : names;
}

std::string run_file_text(const RunPlan& plan, const algos::TechniqueChoice& technique,
                          const std::string& gpu_file) {
  const ViewPlan& view = plan.view;
  const bool is_path =
      view.scene.ends_with(".gltf") || view.scene.ends_with(".glb") || is_image_file(view.scene);
  return fmt::format(
      "schema = {}\nkind = \"run\"\nscene = {}\ntechnique = {}\ngpu = {}\nengine = {}\ndetailed_sample = {}\n"
      "width_px = {}\nheight_px = {}\ncamera = {}\npoint_lights = {}\nlight_range = {}\nlights = {}\nshadows "
      "= "
      "{}\nshadow_map_px = {}\n"
      "emulator_skip = {}\nreference_samples = {}\n",
      kSchema, quoted(is_path ? fs::absolute(view.scene).lexically_normal().string() : view.scene),
      quoted(algos::technique_text(technique, true)), quoted(gpu_file),
      quoted(std::string(engine_name(plan.engine))), to_toml(TomlValue(plan.timing.detailed_sample_ratio)),
      view.resolution.width_px, view.resolution.height_px, quoted(view.camera), view.point_lights,
      to_toml(TomlValue(view.light_range)), quoted(std::string(light_profile_name(view.lights))),
      view.shadows, view.shadow_map_px, quoted(skip_text(plan.skip)), plan.reference_samples);
}

}  // namespace hwsim::cli
