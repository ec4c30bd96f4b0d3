#include "hwsim/config/settings.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "hwsim/config/assign.h"

namespace hwsim {
namespace {

std::string bounds_text(const KeyInfo& info) {
  return "must be between " + to_toml(info.low) + " and " + to_toml(info.high);
}

std::string meaning(const KeyInfo& info) {
  return "`" + std::string(info.name) + "`: " + std::string(info.description);
}

bool is_switch_or_text(const Key& key) {
  return std::holds_alternative<bool*>(key.slot) || std::holds_alternative<std::string*>(key.slot);
}

Diagnostic wrong_type(const Key& key, const TomlValue& value, const SourcePlace& place) {
  Diagnostic d;
  d.code = "C013";
  d.message = "`" + std::string(key.info.name) + "` is a " + std::string(type_name(value)) + ", must be a " +
              std::string(expected_type(key));
  d.place = place;
  d.help = "give a " + std::string(expected_type(key)) + "; " + meaning(key.info);
  return d;
}

/// The value as a real where the key takes numbers and this is one of the right kind.
std::optional<double> number_for(const Key& key, const TomlValue& value) {
  const bool whole = std::holds_alternative<int*>(key.slot) || key.info.has(kWhole);
  if (const auto* i = std::get_if<std::int64_t>(&value)) return static_cast<double>(*i);
  const auto* d = std::get_if<double>(&value);
  if (!d || (whole && std::isfinite(*d) && *d != std::floor(*d))) return std::nullopt;
  return *d;
}

bool inside(const KeyInfo& info, double number) { return number >= info.low && number <= info.high; }

Diagnostic out_of_range(const Key& key, const TomlValue& value, const SourcePlace& place) {
  Diagnostic d;
  d.code = "C014";
  d.message = "`" + std::string(key.info.name) + "` is " + to_toml(value) + ", " + bounds_text(key.info);
  d.place = place;
  d.help = "give a number of that range; " + meaning(key.info);
  return d;
}

}  // namespace

std::string_view expected_type(const Key& key) {
  if (std::holds_alternative<bool*>(key.slot)) return "boolean (true or false)";
  if (std::holds_alternative<std::string*>(key.slot)) return "text";
  return std::holds_alternative<int*>(key.slot) || key.info.has(kWhole) ? "whole number" : "number";
}

bool assign(const Key& key, const TomlValue& value, const SourcePlace& place,
            std::vector<Diagnostic>& problems) {
  if (auto* const* text = std::get_if<std::string*>(&key.slot)) {
    if (const auto* s = std::get_if<std::string>(&value)) return **text = *s, true;
    return problems.push_back(wrong_type(key, value, place)), false;
  }
  if (auto* const* flag = std::get_if<bool*>(&key.slot)) {
    if (const auto* b = std::get_if<bool>(&value)) return **flag = *b, true;
    return problems.push_back(wrong_type(key, value, place)), false;
  }
  const auto number = number_for(key, value);
  if (!number) return problems.push_back(wrong_type(key, value, place)), false;
  if (!inside(key.info, *number)) return problems.push_back(out_of_range(key, value, place)), false;
  if (auto* const* whole = std::get_if<int*>(&key.slot))
    **whole = static_cast<int>(*number);
  else
    *std::get<double*>(key.slot) = *number;
  return true;
}

std::optional<double> scale_factor(const Key& key, const TomlValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  if (is_switch_or_text(key) || !text || text->size() < 2 || text->front() != 'x') return std::nullopt;
  double factor = 0.0;
  const char* const end = text->data() + text->size();
  const auto [stop, error] = std::from_chars(text->data() + 1, end, factor);
  if (error != std::errc() || stop != end || !std::isfinite(factor)) return std::nullopt;
  return factor;
}

TomlValue scaled(const TomlValue& value, double factor) {
  const auto* whole = std::get_if<std::int64_t>(&value);
  const auto* real = std::get_if<double>(&value);
  if (!whole && !real) return value;
  const double product = (whole ? static_cast<double>(*whole) : *real) * factor;
  constexpr double kExact = 9007199254740992.0;  // 2^53: whole numbers below are doubles
  if (whole && product == std::floor(product) && std::abs(product) < kExact)
    return static_cast<std::int64_t>(product);
  return product;
}

TomlValue value_in(const KeySlot& slot) {
  if (auto* const* d = std::get_if<double*>(&slot)) return **d;
  if (auto* const* i = std::get_if<int*>(&slot)) return static_cast<std::int64_t>(**i);
  if (auto* const* b = std::get_if<bool*>(&slot)) return **b;
  return *std::get<std::string*>(slot);
}

std::optional<Diagnostic> check_range(const Key& key) {
  if (is_switch_or_text(key)) return std::nullopt;
  const TomlValue value = value_in(key.slot);
  const auto number = number_for(key, value);
  if (!number) return wrong_type(key, value, {});
  if (!inside(key.info, *number)) return out_of_range(key, value, {});
  return std::nullopt;
}

const Key* find_key(std::span<const Key> keys, std::string_view name) {
  const auto found =
      std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.info.name == name; });
  return found == keys.end() ? nullptr : &*found;
}

std::string nearest_key(std::span<const Key> keys, std::string_view name) {
  std::vector<std::string> names, last_parts;
  for (const Key& key : keys) names.emplace_back(key.info.name);
  if (const std::string near = nearest_name(name, names); !near.empty()) return near;
  for (const std::string& full : names) {  // "float_atomics" at the top level means "features.float_atomics"
    const auto dot = full.rfind('.');
    if (dot != std::string::npos && full.substr(dot + 1) == name.substr(name.rfind('.') + 1)) return full;
  }
  return {};
}

Diagnostic unknown_key(std::span<const Key> keys, std::string_view name, std::string_view subject,
                       SourcePlace place) {
  Diagnostic d;
  d.code = "C012";
  d.message = "unknown key `" + shortened(name) + "` in " + std::string(subject);
  d.place = std::move(place);
  const std::string near = nearest_key(keys, name);
  if (!near.empty()) d.hint = "did you mean `" + near + "`?";
  d.help = "take a key that it has, or leave this one out";
  return d;
}

SourcePlace command_line_place(const Assignment& assignment, bool at_value) {
  SourcePlace place;
  place.file = "(command line)";
  place.line = 1;
  place.line_text = "--set " + assignment.path + "=" + assignment.value;
  const std::string& marked = at_value ? assignment.value : assignment.path;
  place.column = at_value ? static_cast<int>(6 + assignment.path.size() + 2) : 7;
  place.length = std::max(1, static_cast<int>(marked.size()));
  return place;
}

std::optional<TomlValue> value_of_assignment(const Assignment& assignment,
                                             std::vector<Diagnostic>& problems) {
  try {
    return parse_toml_value(assignment.value);
  } catch (const InputError& error) {
    for (Diagnostic d : error.diagnostics()) {
      d.place = command_line_place(assignment, true);
      problems.push_back(std::move(d));
    }
  }
  return std::nullopt;
}

void apply_settings(std::string_view group, std::span<const Key> keys, std::span<const Assignment> sets,
                    std::vector<Diagnostic>& problems) {
  for (const Assignment& set : sets) {
    if (set.group() != group) continue;
    const std::string name =
        set.path.size() > group.size() ? set.path.substr(group.size() + 1) : std::string();
    const Key* key = find_key(keys, name);
    if (!key && problems.size() >= kProblemsShown) {  // counted; nobody reads it
      problems.emplace_back();
      continue;
    }
    if (!key) {
      Diagnostic d =
          unknown_key(keys, name, "group `" + std::string(group) + "`", command_line_place(set, false));
      d.notes.push_back("set on the command line");
      problems.push_back(std::move(d));
      continue;
    }
    if (const auto value = value_of_assignment(set, problems))
      assign(*key, *value, command_line_place(set, true), problems);
  }
}

void check_groups(std::span<const Assignment> sets, std::span<const std::string> groups) {
  std::vector<Diagnostic> problems;
  for (const Assignment& set : sets) {
    if (std::find(groups.begin(), groups.end(), set.group()) != groups.end()) continue;
    Diagnostic d;
    d.code = "C020";
    d.message = "unknown group `" + set.group() + "` in `--set " + set.path + "`";
    d.place = command_line_place(set, false);
    d.hint = did_you_mean(set.group(), groups);
    d.help = "the groups are";
    for (const std::string& group : groups) d.help += " " + group;
    problems.push_back(std::move(d));
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace hwsim
