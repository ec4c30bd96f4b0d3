// A GpuConfig as text: TOML, JSON schema, hashes, one value.
#include "hwsim/gpu/gpu_show.h"

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "hwsim/base/content_hash.h"
#include "hwsim/config/assign.h"
#include "hwsim/gpu/gpu_keys.h"

namespace hwsim {
namespace {

/// Slots that are only read: nothing in this file writes through one. (A copy would take its origins along,
/// too, a hundred texts.)
std::vector<Key> keys_of_const(const GpuConfig& config) { return keys_of(const_cast<GpuConfig&>(config)); }

bool is_label(const KeyInfo& info) {
  return info.name == "title" || info.name == "vendor" || info.name == "architecture";
}

std::string with_metadata(const std::string& value, const Origin& origin) {
  if (!origin.provenance && origin.source.empty() && !origin.interval) return value;
  std::string text = "{ value = " + value;
  if (origin.provenance)
    text += ", provenance = \"" + std::string(provenance_name(*origin.provenance)) + "\"";
  if (!origin.source.empty()) text += ", source = " + to_toml(origin.source);
  if (origin.interval)
    text += ", interval = [" + to_toml((*origin.interval)[0]) + ", " + to_toml((*origin.interval)[1]) + "]";
  return text + " }";
}

/// A source text may hold line ends, which would leave the comment.
std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

std::string fnv1a_hex(std::string_view text) {
  char hex[17];
  std::snprintf(hex, sizeof hex, "%016llx", static_cast<unsigned long long>(fnv1a(text)));
  return hex;
}

template <class Wanted>
std::string hash_of(const GpuConfig& config, Wanted wanted) {
  std::string text;
  for (const Key& key : keys_of_const(config))
    if (wanted(key.info)) text += std::string(key.info.name) + "=" + to_toml(value_in(key.slot)) + "\n";
  return fnv1a_hex(text);
}

std::string header_text(const GpuConfig& config) {
  return "schema = 1\nkind = \"gpu\"\nid = " + to_toml(config.id) + "\n";
}

template <class Wanted>
std::string keys_text(const GpuConfig& config, bool with_origin, Wanted wanted) {
  std::string text, group;
  for (const Key& key : keys_of_const(config)) {
    if (!wanted(key.info)) continue;
    std::string name(key.info.name);
    if (const auto dot = name.find('.'); dot != std::string::npos) {
      if (name.substr(0, dot) != group) text += "\n[" + (group = name.substr(0, dot)) + "]\n";
      name = name.substr(dot + 1);
    }
    const auto origin = config.origins.find(key.info.name);
    const bool known = origin != config.origins.end();
    const std::string value = to_toml(value_in(key.slot));
    text += name + " = " + (known ? with_metadata(value, origin->second) : value);
    if (with_origin && known) text += "  # " + one_line(origin->second.to_string());
    text += "\n";
  }
  return text;
}

nlohmann::ordered_json scalar_schema(const Key& key) {
  nlohmann::ordered_json schema;
  if (std::holds_alternative<bool*>(key.slot))
    schema["type"] = "boolean";
  else if (std::holds_alternative<std::string*>(key.slot))
    schema["type"] = "string";
  else {
    schema["type"] = std::holds_alternative<int*>(key.slot) || key.info.has(kWhole) ? "integer" : "number";
    schema["minimum"] = key.info.low;
    schema["maximum"] = key.info.high;
  }
  return schema;
}

nlohmann::ordered_json default_json(const TomlValue& value) {
  return std::visit([](const auto& v) { return nlohmann::ordered_json(v); }, value);
}

nlohmann::ordered_json key_schema(const Key& key) {
  nlohmann::ordered_json annotated = {
      {"type", "object"},
      {"properties",
       {{"value", scalar_schema(key)},
        {"provenance", {{"enum", {"published", "measured", "fitted", "derived", "assumed"}}}},
        {"source", {{"type", "string"}}},
        {"interval",
         {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 2}, {"maxItems", 2}}}}},
      {"required", {"value"}},
      {"additionalProperties", false}};
  nlohmann::ordered_json schema;
  schema["description"] = std::string(key.info.description);
  if (!key.info.has(kRequired)) schema["default"] = default_json(value_in(key.slot));
  schema["anyOf"] = nlohmann::ordered_json::array({scalar_schema(key), annotated});
  const bool number = std::holds_alternative<double*>(key.slot) || std::holds_alternative<int*>(key.slot);
  if (number)  // a factor on what is inherited
    schema["anyOf"].push_back({{"type", "string"}, {"pattern", "^x[0-9]*[.]?[0-9]+(e[+-]?[0-9]+)?$"}});
  return schema;
}

nlohmann::ordered_json header_schema() {
  return {
      {"schema", {{"const", 1}}},
      {"kind", {{"enum", {"gpu", "overlay"}}}},
      {"about", {{"type", "string"}, {"description", "of an overlay: one sentence"}}},
      {"id", {{"type", "string"}}},
      {"extends", {{"type", "string"}, {"description", "id, or path relative to this file; one parent"}}}};
}

}  // namespace

std::string_view provenance_name(Provenance provenance) {
  switch (provenance) {
    case Provenance::published:
      return "published";
    case Provenance::measured:
      return "measured";
    case Provenance::fitted:
      return "fitted";
    case Provenance::derived:
      return "derived";
    case Provenance::assumed:
      return "assumed";
  }
  return "assumed";
}

std::string Origin::to_string() const {
  if (layer == Layer::built_in) return "built-in default, assumed";
  if (layer == Layer::command_line) return "--set";
  std::string text = std::filesystem::path(file).filename().string() + ":" + std::to_string(line);
  if (layer == Layer::overlay) text += " (overlay)";
  if (layer == Layer::parent) text += " (inherited)";
  if (provenance) text += ", " + std::string(provenance_name(*provenance));
  if (!source.empty()) text += " " + source;
  return text;
}

std::vector<KeyInfo> gpu_keys() {
  GpuConfig config;
  std::vector<KeyInfo> infos;
  for (const Key& key : keys_of(config)) infos.push_back(key.info);
  return infos;
}

std::string show(const GpuConfig& config, bool with_origin) {
  return header_text(config) + keys_text(config, with_origin, [](const KeyInfo&) { return true; });
}

std::string show_extension(const GpuConfig& config, const std::string& parent,
                           const std::set<std::string>& keys) {
  return header_text(config) + "extends = " + to_toml(parent) + "\n" +
         keys_text(config, false, [&](const KeyInfo& info) { return keys.contains(std::string(info.name)); });
}

std::string value_of(const GpuConfig& config, std::string_view name) {
  const std::vector<Key> keys = keys_of_const(config);
  const Key* key = find_key(keys, name);
  return key ? to_toml(value_in(key->slot)) : std::string();
}

std::string content_hash(const GpuConfig& config) {
  return hash_of(config, [](const KeyInfo& info) { return !is_label(info); });
}

std::set<std::string> hashed_keys() {
  std::set<std::string> names;
  for (const KeyInfo& info : gpu_keys())
    if (!is_label(info)) names.emplace(info.name);
  return names;
}

std::string content_hash(const GpuConfig& config, const std::set<std::string>& keys) {
  const std::vector<Key> known = keys_of_const(config);
  std::string text;
  for (const std::string& name : keys) {
    const Key* key = find_key(known, name);
    text += name + "=" + (key ? to_toml(value_in(key->slot)) : std::string()) + "\n";
  }
  return fnv1a_hex(text);
}

std::string functional_hash(const GpuConfig& config) {
  return hash_of(config, [](const KeyInfo& info) { return info.name.find('.') != std::string_view::npos; });
}

std::string gpu_schema_json() {
  GpuConfig config;
  nlohmann::ordered_json properties = header_schema();
  nlohmann::ordered_json required = nlohmann::ordered_json::array({"schema", "kind"});
  for (const Key& key : keys_of(config)) {
    const std::string name(key.info.name);
    const auto dot = name.find('.');
    if (dot == std::string::npos) {
      properties[name] = key_schema(key);
      continue;
    }
    nlohmann::ordered_json& group = properties[name.substr(0, dot)];
    if (group.is_null()) group = {{"type", "object"}, {"additionalProperties", false}};
    group["properties"][name.substr(dot + 1)] = key_schema(key);
  }
  // Keys without a default are not listed under "required": an overlay, or a file that extends another,
  // leaves them out.
  nlohmann::ordered_json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                                   {"title", "hwsim GPU"},
                                   {"type", "object"}};
  schema["required"] = required;
  schema["properties"] = properties;
  schema["additionalProperties"] = false;
  return schema.dump(2) + "\n";
}

std::span<const ConfigCode> config_codes() {
  static constexpr ConfigCode kCodes[] = {
      {"C010", "file cannot be read",
       "The path does not exist, is not a file, is larger than 4 MiB, or may not be read."},
      {"C011", "not TOML",
       "The file breaks the syntax of TOML 1.0, or nests more than 16 levels; the mark stands where reading "
       "stopped."},
      {"C012", "unknown key",
       "No key has this name. A misspelled key would silently change nothing, so it is an error."},
      {"C013", "wrong type",
       "The key takes another type: a number, a whole number, true or false, or a text."},
      {"C014", "out of range", "The number is outside the range in which the model means anything."},
      {"C015", "missing key",
       "The key has no default: a GPU file, or the file that it extends, must give it."},
      {"C016", "unknown GPU", "No file of the GPU folder has this name."},
      {"C017", "extends without an end",
       "A file extends itself, directly or through others, or more than 16 files extend each other."},
      {"C018", "keys contradict each other",
       "Each value is allowed, but not together; the notes name every key."},
      {"C019", "wrong kind of file",
       "`schema`, `kind`, `id` or `extends` is missing or wrong for this use of the file."},
      {"C020", "not a setting",
       "`--set` takes group.key=value, with a group that some part of the program reads."},
      {"C021", "not a value", "`--set` takes one boolean, number or text."},
      {"C022", "bad table of a value",
       "{ value, provenance, source, interval = [low, high] } is what a value may carry."},
      {"C023", "two GPUs of one name",
       "Their ids name the same folder, so that the results of one would overwrite those of the other."},
      {"C024", "rate of another chip",
       "A file changes the number of cores, ROPs or rasterizers, or the bandwidth, and keeps a rate that "
       "goes with it "
       "from the GPU that it extends."},
      {"C025", "one number, two names",
       "A file says a number by its key and by a word of data sheets, or by two of these: nothing says which "
       "one holds."},
  };
  return kCodes;
}

}  // namespace hwsim
