#include "lab/results/run_files.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <cctype>
#include <filesystem>

#include "lab/base/build_info.h"
#include "lab/base/files.h"
#include "lab/base/json_text.h"
#include "lab/request/run_file.h"

namespace hwsim::lab {
namespace {

using Json = nlohmann::ordered_json;

std::string host_text() {
  utsname names{};
  if (uname(&names) != 0) return "unknown";
  return fmt::format("{} {} {}", names.sysname, names.release, names.machine);
}

}  // namespace

void write_point_files(const std::string& folder, const PointResult& point, const RunPlan& plan,
                       const std::string& scene_name) {
  std::filesystem::create_directories(folder);
  write_file(folder + "/result.json", json_text(to_json(make_result(point, plan, scene_name))));
  write_file(folder + "/passes.csv", to_csv(wide_pass_table(point)));
  write_file(folder + "/counters.csv", to_csv(counter_table(point)));
  write_file(folder + "/trace.json", trace_event_json(point));
  write_file(folder + "/run.toml", run_file_text(plan, *point.technique, "gpu.toml"));
  write_file(folder + "/gpu.toml", show(*point.gpu, true));
}

std::string point_folder(const PointResult& point) {
  std::string name = algos::technique_text(*point.technique) + "@" + point.gpu->id;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 &&
        std::string_view("@+-_.").find(c) == std::string_view::npos)
      c = '_';
  return name;
}

Json manifest(const ManifestInput& input) {
  const BuildInfo build = build_info();
  Json json;
  json["schema_version"] = kResultSchemaVersion;
  json["version"] = build.version;
  json["model_version"] = model_version();
  json["commit"] = build.commit;
  json["compiler"] = build.compiler;
  json["build_type"] = build.build_type;
  json["vector_targets"] = build.vector_targets;
  json["host"] = host_text();
  json["argv"] = input.arguments;
  json["request"] = {{"view", to_json(input.plan->view)}, {"settings", to_json(settings_of(*input.plan))}};
  json["overrides"] = Json::object();
  for (const Assignment& set : input.plan->overrides) json["overrides"][set.path] = set.value;
  json["seed"] = 0;  // nothing is drawn at random outside the scene's own seed, which is part of its name
  Json hashes;
  if (input.scene) hashes["scene"] = input.scene->content_hash;
  for (const GpuConfig& gpu : input.plan->gpus) hashes["gpu"][gpu.id] = content_hash(gpu);
  json["input_hashes"] = hashes;
  json["scene"] = input.plan->view.scene;
  json["points"] = Json::array();
  for (const algos::TechniqueChoice& technique : input.plan->techniques)
    for (const GpuConfig& gpu : input.plan->gpus)
      json["points"].push_back({{"technique", algos::technique_text(technique, true)}, {"gpu", gpu.id}});
  json["notes"] = Json::array();
  if (input.scene)
    for (const Diagnostic& note : input.scene->notes) json["notes"].push_back(note.message);
  json["wall_s"] = input.wall_s;
  json["fragments_per_s"] = input.emulation_s > 0.0
                                ? Json(static_cast<double>(input.fragments) / input.emulation_s)
                                : Json(nullptr);
  json["reused_passes"] = input.reused_passes;
  json["state"] = input.state;
  return json;
}

std::string manifest_schema_json() {
  Json request;
  View view;
  Settings settings;
  for (const auto& [part, fields] : {std::pair("view", fields_of(view)), {"settings", fields_of(settings)}}) {
    Json properties, names = Json::array();
    for (const Field& field : fields) {
      properties[std::string(field.info.key.name)] = field_schema(field);
      names.push_back(std::string(field.info.key.name));
    }
    request[part] = {
        {"type", "object"}, {"required", names}, {"properties", properties}, {"additionalProperties", false}};
  }
  const Json schema = {
      {"$schema", "https://json-schema.org/draft/2020-12/schema"},
      {"title", "hwsim manifest"},
      {"type", "object"},
      {"required", {"schema_version", "model_version", "request", "points", "state"}},
      {"properties",
       {{"schema_version", {{"const", kResultSchemaVersion}}},
        {"request", {{"type", "object"}, {"required", {"view", "settings"}}, {"properties", request}}}}}};
  return json_text(schema);
}

}  // namespace hwsim::lab
