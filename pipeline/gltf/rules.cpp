#include "pipeline/gltf/rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>

#include "pipeline/gltf/ranges.h"
#include "pipeline/gltf/rule_table.h"

namespace hwsim::pipeline::gltf {
namespace {
using nlohmann::json;

constexpr std::size_t kMaxErrors = 20;
constexpr int kMaxNesting = 64;

// Also writes whole numbers as integers: JSON knows one kind of number, but the parser takes 1.0 and 4.8e1
// for no integer and would leave the key out.
class RuleChecker {
 public:
  RuleChecker(const Report& report, json& root) : report_(report), root_(root) {}

  void check_object(json& object, std::span<const Rule> rules, const std::string& where) {
    for (const Rule& rule : rules) {
      const auto found = object.find(rule.key);
      const std::string path = where.empty() ? rule.key : where + "." + rule.key;
      if (found != object.end())
        check_value(*found, rule, path);
      else if (rule.required)
        add("S004", path + " is missing");
    }
  }

  std::vector<Diagnostic> take() { return std::move(errors_); }

 private:
  void add(const char* code, const std::string& message) {
    if (errors_.size() < kMaxErrors) errors_.push_back(report_.error(code, message));
  }

  void check_value(json& value, const Rule& rule, const std::string& path) {
    switch (rule.kind) {
      case Kind::text:
        return expect(value.is_string(), path, "a string", value);
      case Kind::boolean:
        return expect(value.is_boolean(), path, "true or false", value);
      case Kind::number:
        return expect(is_finite(value), path, "a number", value);
      case Kind::count:
        return check_count(value, path);
      case Kind::index:
        return check_index(value, rule.target, path);
      case Kind::numbers:
        return check_numbers(value, rule, path);
      case Kind::texts:
        return check_each(value, path,
                          [&](json& v, const std::string& p) { expect(v.is_string(), p, "a string", v); });
      case Kind::indices:
        return check_each(value, path,
                          [&](json& v, const std::string& p) { check_index(v, rule.target, p); });
      case Kind::objects:
        return check_each(value, path, [&](json& v, const std::string& p) { check_nested(v, rule, p); });
      case Kind::object:
        return check_nested(value, rule, path);
      case Kind::index_map:
        return check_index_map(value, rule, path);
      case Kind::index_maps:
        return check_each(value, path, [&](json& v, const std::string& p) { check_index_map(v, rule, p); });
      case Kind::object_map:
        return check_object_map(value, rule, path);
      case Kind::values:
        return expect(value.is_array(), path, "an array", value);
    }
  }

  template <class Check>
  void check_each(json& value, const std::string& path, Check check) {
    expect(value.is_array(), path, "an array", value);
    if (!value.is_array()) return;
    for (std::size_t i = 0; i < value.size() && errors_.size() < kMaxErrors; ++i)
      check(value[i], path + "[" + std::to_string(i) + "]");
  }

  void check_nested(json& value, const Rule& rule, const std::string& path) {
    expect(value.is_object(), path, "an object", value);
    if (value.is_object()) check_object(value, rule.children, path);
  }

  void check_index_map(json& value, const Rule& rule, const std::string& path) {
    expect(value.is_object(), path, "an object", value);
    if (!value.is_object()) return;
    for (auto& [key, item] : value.items()) check_index(item, rule.target, path + "." + key);
  }

  void check_object_map(json& value, const Rule& rule, const std::string& path) {
    expect(value.is_object(), path, "an object", value);
    if (!value.is_object()) return;
    for (const auto& [key, item] : value.items())
      expect(item.is_object(), path + "." + key, "an object", item);
    check_object(value, rule.children, path);
  }

  void check_numbers(const json& value, const Rule& rule, const std::string& path) {
    const bool right = value.is_array() && (rule.length == 0 || value.size() == rule.length) &&
                       std::all_of(value.begin(), value.end(), is_finite);
    expect(right, path, rule.length ? std::to_string(rule.length) + " numbers" : "an array of numbers",
           value);
  }

  void check_count(json& value, const std::string& path) {
    expect(is_count(value), path, "a whole number from 0 to 9007199254740991", value);
    if (value.is_number_float() && is_count(value)) value = static_cast<std::uint64_t>(value.get<double>());
  }

  void check_index(json& value, const char* target, const std::string& path) {
    check_count(value, path);
    if (!is_count(value)) return;
    const std::size_t size = target_size(target);
    if (value.get<double>() >= static_cast<double>(size))
      add("S005", path + " is " + value.dump() + ", but the file has " + std::to_string(size) + " " + target);
  }

  std::size_t target_size(std::string_view target) const {
    const json::json_pointer path(target == "lights" ? "/extensions/KHR_lights_punctual/lights"
                                                     : "/" + std::string(target));
    if (!root_.contains(path)) return 0;
    const json& array = root_.at(path);
    return array.is_array() ? array.size() : 0;
  }

  void expect(bool right, const std::string& path, const std::string& wanted, const json& value) {
    if (right) return;
    std::string shown = value.dump(-1, ' ', true, json::error_handler_t::replace);
    if (shown.size() > 40) shown = shown.substr(0, 37) + "...";
    add("S004", path + " is " + shown + ", must be " + wanted);
  }

  static bool is_finite(const json& value) { return value.is_number() && std::isfinite(value.get<double>()); }
  // 2^53: whole numbers that a double holds; sums and products of two below stay inside 64 bits where it
  // matters.
  static bool is_count(const json& value) {
    if (!value.is_number()) return false;
    const double number = value.get<double>();
    return number >= 0 && number < 9007199254740992.0 && number == std::floor(number);
  }

  const Report& report_;
  json& root_;
  std::vector<Diagnostic> errors_;
};

// Parsers and value trees recurse once for each level; bytes inside strings do not count.
bool nests_too_deep(std::string_view text) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kMaxNesting) return true;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return false;
}

void check_asset(const Report& report, const json& root) {
  const auto asset = root.find("asset");
  if (asset == root.end() || !asset->is_object() || !asset->contains("version") ||
      !(*asset)["version"].is_string())
    report.fail("S014", "asset.version is missing", "the file is no glTF 2.0: export it again");
  const std::string version = (*asset)["version"];
  if (version.rfind("2.", 0) != 0)
    report.fail("S014", "glTF version \"" + version + "\" is not supported, it must be 2.x",
                "convert the file to glTF 2.0");
}

void check_required_extensions(const Report& report, const json& root) {
  const auto required = root.find("extensionsRequired");
  if (required == root.end() || !required->is_array()) return;  // a wrong type is found by the rules
  std::vector<Diagnostic> errors;
  for (const json& name : *required)
    if (name.is_string() && !is_honored_extension(name.get<std::string>()))
      errors.push_back(report.error("S006",
                                    "the file requires the extension " + name.get<std::string>() +
                                        ", which is not supported; nothing was loaded",
                                    "export without it (no mesh compression, PNG or JPEG images)"));
  if (!errors.empty()) throw InputError(std::move(errors));
}

}  // namespace

bool is_honored_extension(std::string_view name) {
  constexpr std::array<std::string_view, 5> kHonored = {
      "KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_unlit",
      "KHR_mesh_quantization", "KHR_texture_transform"};
  return std::find(kHonored.begin(), kHonored.end(), name) != kHonored.end();
}

json parse_json(const Report& report, std::string_view text) {
  if (nests_too_deep(text))
    report.fail("S003", "the JSON nests deeper than " + std::to_string(kMaxNesting) + " levels");
  try {
    json root = json::parse(text);
    if (!root.is_object()) report.fail("S003", "the JSON's outermost value is not an object");
    return root;
  } catch (const json::exception& e) {
    // "[json.exception.parse_error.101] parse error at line 3, column 7: ..." without the bracket
    std::string what = e.what();
    if (const auto bracket = what.find("] "); bracket != std::string::npos) what.erase(0, bracket + 2);
    report.fail("S003", "JSON " + what, "the file is damaged: export or copy it again");
  }
}

void check_rules(Report& report, json& root) {
  check_asset(report, root);
  check_required_extensions(report, root);
  RuleChecker checker(report, root);
  checker.check_object(root, root_rules(), "");
  if (auto errors = checker.take(); !errors.empty()) throw InputError(std::move(errors));
  if (auto errors = check_ranges(report, root); !errors.empty()) throw InputError(std::move(errors));
}

}  // namespace hwsim::pipeline::gltf
