#include "hwsim/config/toml_value.h"

#include <toml++/toml.h>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

#include "hwsim/base/diagnostics.h"
#include "hwsim/config/toml_nesting.h"

namespace hwsim {
namespace {

[[noreturn]] void fail_value(std::string_view text, std::string reason, std::string help) {
  Diagnostic d{.code = "C021", .message = "`" + shortened(text) + "` is no value: " + std::move(reason)};
  d.help = std::move(help);
  throw InputError(std::move(d));
}

bool has_control_character(std::string_view text) {
  for (const char c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) return true;
  return false;
}

bool looks_quoted_or_nested(std::string_view text) {
  return text.starts_with('"') || text.starts_with('\'') || text.starts_with('[') || text.starts_with('{');
}

std::optional<TomlValue> scalar_of(const toml::node& node) {
  if (const auto* v = node.as_boolean()) return TomlValue(v->get());
  if (const auto* v = node.as_integer()) return TomlValue(v->get());
  if (const auto* v = node.as_floating_point()) return TomlValue(v->get());
  if (const auto* v = node.as_string()) return TomlValue(v->get());
  return std::nullopt;
}

/// A basic string on one line.
std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (has_control_character(std::string_view(&c, 1))) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04X", static_cast<unsigned>(static_cast<unsigned char>(c)));
      out += code;
    } else {
      out += c;
    }
  }
  return out + "\"";
}

}  // namespace

TomlValue parse_toml_value(std::string_view text) {
  if (text.empty()) fail_value(text, "it is empty", "write \"\" for an empty text");
  if (has_control_character(text)) fail_value("...", "it holds a control character", "escape it in quotes");
  // A '#' would start a comment; in a bare string ("#ff0000") it is part of the text.
  if (!looks_quoted_or_nested(text) && text.find('#') != std::string_view::npos) return std::string(text);
  if (looks_quoted_or_nested(text) && too_deep(text))
    fail_value(text, "arrays, tables and dates are not taken here", "give one boolean, number or text");
  if (too_deep(text)) return std::string(text);
  try {
    const toml::table table = toml::parse("v = " + std::string(text));
    if (table.size() == 1)
      if (const auto value = scalar_of(*table.get("v"))) return *value;
  } catch (const toml::parse_error& error) {
    if (!looks_quoted_or_nested(text)) return std::string(text);
    fail_value(text, std::string(error.description()), "quote a text as \"...\", or leave the quotes out");
  }
  fail_value(text, "arrays, tables and dates are not taken here", "give one boolean, number or text");
}

std::string to_toml(const TomlValue& value) {
  if (const auto* b = std::get_if<bool>(&value)) return *b ? "true" : "false";
  if (const auto* i = std::get_if<std::int64_t>(&value)) return std::to_string(*i);
  if (const auto* s = std::get_if<std::string>(&value)) return quoted(*s);
  const double number = std::get<double>(value);
  if (std::isnan(number)) return "nan";
  if (std::isinf(number)) return number > 0 ? "inf" : "-inf";
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, number).ptr;
  std::string text(buffer, end);
  if (text.find_first_of(".e") == std::string::npos)
    text += ".0";  // TOML tells reals from integers by their look
  return text;
}

std::string_view type_name(const TomlValue& value) {
  if (std::holds_alternative<bool>(value)) return "boolean";
  if (std::holds_alternative<std::int64_t>(value)) return "integer";
  if (std::holds_alternative<double>(value)) return "real number";
  return "text";
}

Assignment parse_assignment(std::string_view text) {
  const auto equals = text.find('=');
  Diagnostic d;
  d.code = "C020";
  d.help = "write --set group.key=value, e.g. --set gpu.core_clock_mhz=1500";
  if (equals == std::string_view::npos) {
    d.message = "`" + std::string(text) + "` assigns nothing: it has no `=`";
    throw InputError(d);
  }
  const auto trim = [](std::string_view s) {
    while (s.starts_with(' ')) s.remove_prefix(1);
    while (s.ends_with(' ')) s.remove_suffix(1);
    return std::string(s);
  };
  Assignment assignment{trim(text.substr(0, equals)), trim(text.substr(equals + 1))};
  const auto dot = assignment.path.find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == assignment.path.size()) {
    d.message = "`" + assignment.path + "` is no path: it must be a group, a dot and a key";
    throw InputError(d);
  }
  return assignment;
}

}  // namespace hwsim
