#include "lab/request/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "hwsim/base/file_name.h"
#include "hwsim/config/assign.h"
#include "hwsim/config/settings.h"
#include "lab/base/messages.h"
#include "lab/base/text.h"
#include "lab/request/image_input.h"
#include "lab/request/request_words.h"
#include "lab/request/run_file.h"
#include "pipeline/open/scene_source.h"

namespace hwsim::lab {
namespace {

struct FieldCollector {
  std::vector<Field> fields;
  template <class Value>
  void field(const FieldInfo& info, Value& value) {
    fields.push_back({info, KeySlot(&value)});
  }
};

template <class Part>
std::vector<Field> collect(Part& part) {
  FieldCollector collector;
  describe(collector, part);
  return std::move(collector.fields);
}

template <class Part>
std::string key_text_of(Part part, FieldUse use) {  // a copy: slots are not for constants
  std::string text;
  for (const Field& field : collect(part))
    if ((field.info.uses & use) != 0)
      text +=
          fmt::format("{}{} {}", text.empty() ? "" : " ", field.info.key.name, to_toml(value_in(field.slot)));
  return text;
}

template <class Part>
nlohmann::ordered_json json_of(Part part) {
  nlohmann::ordered_json json;
  for (const Field& field : collect(part))
    std::visit([&](const auto& value) { json[std::string(field.info.key.name)] = value; },
               value_in(field.slot));
  return json;
}

std::vector<Key> settable(const std::vector<Field>& fields, std::string_view group) {
  std::vector<Key> keys;
  for (const Field& field : fields)
    if (field.info.group == group) keys.push_back({field.info.key, field.slot});
  return keys;
}

bool is_scene_file(const std::string& scene) {
  return has_extension(scene, ".gltf") || has_extension(scene, ".glb") || is_image_file(scene);
}

/// A key that is neither the view's nor the generator's is told here, where both are known.
void check_generator_keys(const std::string& scene, const std::vector<Key>& view_keys,
                          std::vector<Assignment>& sets, std::vector<Diagnostic>& problems) {
  const std::string name = scene.substr(0, scene.find(':'));
  const auto generator = std::ranges::find(pipeline::generators(), name, &pipeline::GeneratorInfo::name);
  if (generator == pipeline::generators().end()) return;  // told when it is opened
  std::vector<std::string> known;
  for (const Key& key : view_keys) known.emplace_back(key.info.name);
  for (const pipeline::GeneratorParameter& parameter : generator->parameters) known.push_back(parameter.name);
  std::erase_if(sets, [&](const Assignment& set) {
    if (std::ranges::find(known, key_of(set)) != known.end()) return false;
    problems.push_back(
        problem("S202", "neither views nor `" + name + "` have the key `" + key_of(set) + "`",
                did_you_mean(key_of(set), known),
                "`hwsim show " + name + "` lists those of the scene, `hwsim help run` the others"));
    return true;
  });
}

/// scene.* holds values of the view and, for a generated scene, the generator's own parameters; the generator
/// checks the latter.
void apply_to_view(View& view, const std::vector<Assignment>& sets, std::vector<Diagnostic>& problems,
                   bool own_too = true) {
  const std::vector<Key> keys = settable(fields_of(view), "scene");
  std::vector<Assignment> own, generator;
  for (const Assignment& set : sets) {
    if (set.group() != "scene") continue;
    const bool known = std::ranges::any_of(keys, [&](const Key& k) { return k.info.name == key_of(set); });
    (known || is_scene_file(view.scene) ? own : generator).push_back(set);
  }
  if (own_too) apply_settings("scene", keys, own, problems);
  check_generator_keys(view.scene, keys, generator, problems);
  view.scene = with_parameters(view.scene, generator);
}

}  // namespace

std::vector<Field> fields_of(View& view) { return collect(view); }
std::vector<Field> fields_of(Settings& settings) { return collect(settings); }

std::string key_of(const Assignment& set) { return set.path.substr(set.path.find('.') + 1); }

std::optional<Diagnostic> choice_problem(const Field& field, const std::string& name, std::string code) {
  if (field.info.choices.empty()) return std::nullopt;
  const std::vector<std::string> words = split(field.info.choices, '|');
  const std::string& value = *std::get<std::string*>(field.slot);
  if (std::ranges::find(words, value) != words.end()) return std::nullopt;
  return problem(std::move(code),
                 fmt::format("{} is `{}`, must be {} or {}", name, value,
                             fmt::join(words.begin(), words.end() - 1, ", "), words.back()),
                 did_you_mean(value, words));
}

void check_choices(View view, std::vector<Diagnostic>& problems) {
  for (const Field& field : fields_of(view))
    if (auto wrong = choice_problem(field, fmt::format("`scene.{}`", field.info.key.name), "U003"))
      problems.push_back(std::move(*wrong));
}

nlohmann::ordered_json to_json(const View& view) { return json_of(view); }
nlohmann::ordered_json to_json(const Settings& settings) { return json_of(settings); }

nlohmann::ordered_json field_schema(const Field& field) {
  nlohmann::ordered_json schema;
  schema["description"] = std::string(field.info.key.description);
  std::visit([&](const auto& value) { schema["default"] = value; }, value_in(field.slot));
  if (std::holds_alternative<bool*>(field.slot)) {
    schema["type"] = "boolean";
  } else if (std::holds_alternative<std::string*>(field.slot)) {
    schema["type"] = "string";
    if (!field.info.choices.empty()) schema["enum"] = split(field.info.choices, '|');
  } else {
    schema["type"] = std::holds_alternative<int*>(field.slot) ? "integer" : "number";
    schema["minimum"] = field.info.key.low;
    schema["maximum"] = field.info.key.high;
  }
  return schema;
}

std::string key_text(const View& view, FieldUse use) { return key_text_of(view, use); }
std::string key_text(const Settings& settings, FieldUse use) { return key_text_of(settings, use); }

Request open_request(const std::string& scene_or_run_file) {
  if (has_extension(scene_or_run_file, ".toml")) return read_run_file(scene_or_run_file);
  Request request;
  request.view.scene = scene_or_run_file;
  return request;
}

void apply(Request& request, const std::vector<Assignment>& settings, std::vector<Diagnostic>& problems) {
  const std::vector<Assignment> sets = without_words(settings);
  try {
    const std::string scene = request.view.scene;
    apply_words(request, settings);
    const bool other_scene = request.view.scene != scene;  // the first one's name holds its parameters
    if (other_scene) apply_to_view(request.view, request.sets, problems, false);
    check_groups(sets, std::vector<std::string>{"gpu", "scene", "technique", "emulator", "timing"});
  } catch (const InputError& error) {
    append(problems, error);
  }
  const std::vector<Field> fields = fields_of(request.settings);
  for (const std::string_view group : {"emulator", "timing"})
    apply_settings(group, settable(fields, group), sets, problems);
  apply_to_view(request.view, sets, problems);
  request.sets.insert(request.sets.end(), sets.begin(), sets.end());
}

std::string with_parameters(const std::string& text, const std::vector<Assignment>& parameters) {
  std::string result = text;
  for (const Assignment& set : parameters) {
    const std::string key = key_of(set) + "=";
    const auto colon = result.find(':');
    if (colon == std::string::npos) {
      result += ":" + key + set.value;
      continue;
    }
    size_t at = colon + 1;
    while (at < result.size() && result.compare(at, key.size(), key) != 0) {
      const auto comma = result.find(',', at);
      at = comma == std::string::npos ? result.size() : comma + 1;
    }
    if (at < result.size())
      result.replace(at, std::min(result.find(',', at), result.size()) - at, key + set.value);
    else
      result += "," + key + set.value;
  }
  return result;
}

void append(std::vector<Diagnostic>& problems, const InputError& error) {
  problems.insert(problems.end(), error.diagnostics().begin(), error.diagnostics().end());
}

}  // namespace hwsim::lab
