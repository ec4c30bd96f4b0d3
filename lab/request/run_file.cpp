#include "lab/request/run_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "hwsim/base/file_name.h"
#include "hwsim/config/assign.h"
#include "hwsim/config/toml_file.h"
#include "lab/base/json_text.h"
#include "lab/base/messages.h"
#include "lab/request/image_input.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

constexpr int kSchema = 1;

/// What a run.toml holds beside the recorded fields of a request.
struct Header {
  int schema = kSchema;
  std::string kind = "(missing)";
  std::string technique = "none", gpu = "gtx980";
};

std::vector<Field> header_fields(Header& header) {
  return {
      {{{"schema", 0, 1e6, kNoFlags, "version of the file's format"}, "", "schema"}, KeySlot(&header.schema)},
      {{{"kind", 0, 0, kNoFlags, "what the file is"}, "", "kind"}, KeySlot(&header.kind)},
      {{{"technique", 0, 0, kNoFlags, "what is drawn"}, "", "technique"}, KeySlot(&header.technique)},
      {{{"gpu", 0, 0, kNoFlags, "an id, or a file beside this one"}, "", "gpu"}, KeySlot(&header.gpu)}};
}

/// All that a run.toml may hold, in the order in which it is written.
std::vector<Field> recorded_fields(Header& header, Request& request) {
  std::vector<Field> fields = header_fields(header);
  for (const std::vector<Field>& part : {fields_of(request.view), fields_of(request.settings)})
    for (const Field& field : part)
      if (!field.info.file_key.empty()) fields.push_back(field);
  return fields;
}

Key key_in_file(const Field& field) {
  Key key{field.info.key, field.slot};
  key.info.name = field.info.file_key;
  return key;
}

void take(const TomlEntry& entry, const std::vector<Field>& fields, std::vector<Diagnostic>& problems) {
  const auto found = std::ranges::find(fields, entry.path, [](const Field& f) { return f.info.file_key; });
  if (found == fields.end()) {
    std::vector<std::string> known;
    for (const Field& field : fields) known.emplace_back(field.info.file_key);
    Diagnostic d =
        problem("C012", "unknown key `" + entry.path + "` in a run file", did_you_mean(entry.path, known));
    d.place = entry.key_place;
    problems.push_back(std::move(d));
  } else if (!entry.value) {
    Diagnostic d = problem("C013", fmt::format("`{}` is {}, must be a {}", entry.path, entry.found_type,
                                               expected_type(key_in_file(*found))));
    d.place = entry.value_place;
    problems.push_back(std::move(d));
  } else if (assign(key_in_file(*found), *entry.value, entry.value_place, problems)) {
    if (auto wrong = choice_problem(*found, entry.path, "C019")) {
      wrong->place = entry.value_place;
      problems.push_back(std::move(*wrong));
    }
  }
}

void check_header(const Header& header, const TomlFile& file, std::vector<Diagnostic>& problems) {
  const auto complain = [&](const char* key, std::string message) {
    Diagnostic d = problem("C019", std::move(message));
    d.place.file = file.path;
    for (const TomlEntry& entry : file.entries)
      if (entry.path == key) d.place = entry.value_place;
    problems.push_back(std::move(d));
  };
  if (header.schema != kSchema)
    complain("schema", fmt::format("schema is {}, this program reads {}", header.schema, kSchema));
  if (header.kind != "run") complain("kind", "kind is `" + header.kind + "`, must be `run`");
}

/// A path in a file is relative to that file; names of generators and GPUs are no paths.
std::string resolve(const std::string& name, const std::string& file,
                    std::initializer_list<const char*> endings) {
  for (const char* ending : endings)
    if (has_extension(name, ending)) return (fs::path(file).parent_path() / name).lexically_normal().string();
  return name;
}

}  // namespace

Request read_run_file(const std::string& path) {
  std::vector<Diagnostic> problems;
  const TomlFile file = read_toml_file(path, problems);
  Header header;
  Request request;
  const std::vector<Field> fields = recorded_fields(header, request);
  for (const TomlEntry& entry : file.entries) take(entry, fields, problems);
  if (problems.empty()) check_header(header, file, problems);
  if (problems.empty() && request.view.scene.empty()) {
    problems.push_back(problem("C015", "`scene` is missing"));
    problems.back().place.file = path;
  }
  if (!problems.empty()) throw InputError(problems);
  std::string& scene = request.view.scene;
  scene = is_image_file(scene) ? (fs::path(path).parent_path() / scene).lexically_normal().string()
                               : resolve(scene, path, {".gltf", ".glb"});
  request.techniques = {header.technique};
  request.gpus = {resolve(header.gpu, path, {".toml"})};
  return request;
}

std::string run_file_text(const RunPlan& plan, const algos::TechniqueChoice& technique,
                          const std::string& gpu_file) {
  Header header{.kind = "run", .technique = algos::technique_text(technique, true), .gpu = gpu_file};
  Request request{.view = plan.view, .settings = settings_of(plan)};
  std::string& scene = request.view.scene;
  if (has_extension(scene, ".gltf") || has_extension(scene, ".glb") || is_image_file(scene))
    scene = fs::absolute(scene).lexically_normal().string();
  std::string text;
  for (const Field& field : recorded_fields(header, request))
    text += fmt::format("{} = {}\n", field.info.file_key, to_toml(value_in(field.slot)));
  return text;
}

std::string run_schema_json() {
  Header header{.kind = "run"};
  Request request;
  nlohmann::ordered_json properties;
  for (const Field& field : recorded_fields(header, request))
    properties[std::string(field.info.file_key)] = field_schema(field);
  for (const auto& [name, value] : {std::pair("schema", nlohmann::ordered_json(kSchema)), {"kind", "run"}})
    properties[name] = {{"description", properties[name]["description"]}, {"const", value}};
  properties["scene"].erase("default");  // empty: the one value that a file must give
  const nlohmann::ordered_json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                                         {"title", "hwsim run"},
                                         {"type", "object"},
                                         {"required", {"schema", "kind", "scene"}},
                                         {"properties", properties},
                                         {"additionalProperties", false}};
  return json_text(schema);
}

}  // namespace hwsim::lab
