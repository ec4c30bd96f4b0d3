#include "hwsim/config/toml_file.h"

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "hwsim/config/toml_nesting.h"

namespace hwsim {
namespace {

constexpr std::uintmax_t kFileBytesMax = std::uintmax_t{4} << 20;
constexpr std::size_t kLineShown = 240;  // characters of a line, with every value that it holds

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.ends_with('\r')) line.pop_back();
    lines.emplace_back(whole_characters(line, 0, kLineShown));
  }
  return lines;
}

class Flattener {
 public:
  Flattener(std::string file, const std::string& text, std::vector<Diagnostic>& problems)
      : file_(std::move(file)), lines_(split_lines(text)), problems_(problems) {}

  void flatten(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, node] : table) {
      const std::string path = prefix + std::string(key.str());
      const toml::table* child = node.as_table();
      if (child && !is_annotated(*child) && !child->empty())
        flatten(*child, path + ".");
      else
        entries_.push_back(child ? annotated_entry(path, place(key.source()), *child)
                                 : plain_entry(path, place(key.source()), node));
    }
  }

  SourcePlace place(const toml::source_region& region) const {
    SourcePlace p;
    p.file = file_;
    p.line = static_cast<int>(region.begin.line);
    p.column = static_cast<int>(region.begin.column);
    if (region.end.line == region.begin.line && region.end.column > region.begin.column)
      p.length = static_cast<int>(region.end.column - region.begin.column);
    const bool shown = p.column <= static_cast<int>(kLineShown);
    if (shown && p.line >= 1 && static_cast<std::size_t>(p.line) <= lines_.size())
      p.line_text = lines_[static_cast<std::size_t>(p.line) - 1];
    return p;
  }

  SourcePlace place(int line, int column) const {
    toml::source_region region;
    region.begin =
        region.end = {static_cast<toml::source_index>(line), static_cast<toml::source_index>(column)};
    return place(region);
  }

  /// toml++ keeps tables sorted by key; messages and `show` follow the file.
  std::vector<TomlEntry> take() {
    std::stable_sort(entries_.begin(), entries_.end(), [](const TomlEntry& a, const TomlEntry& b) {
      return std::pair(a.key_place.line, a.key_place.column) <
             std::pair(b.key_place.line, b.key_place.column);
    });
    return std::move(entries_);
  }

 private:
  static bool is_annotated(const toml::table& table) { return table.contains("value"); }

  static std::optional<TomlValue> scalar_of(const toml::node& node) {
    if (const auto* v = node.as_boolean()) return TomlValue(v->get());
    if (const auto* v = node.as_integer()) return TomlValue(v->get());
    if (const auto* v = node.as_floating_point()) return TomlValue(v->get());
    if (const auto* v = node.as_string()) return TomlValue(v->get());
    return std::nullopt;
  }

  static std::string found_type(const toml::node& node) {
    if (node.is_array()) return "array";
    if (node.is_table()) return "table";
    return "date or time";
  }

  TomlEntry plain_entry(std::string path, SourcePlace key_place, const toml::node& node) const {
    TomlEntry entry;
    entry.path = std::move(path);
    entry.key_place = std::move(key_place);
    entry.value_place = place(node.source());
    entry.value = scalar_of(node);
    if (!entry.value) entry.found_type = found_type(node);
    return entry;
  }

  TomlEntry annotated_entry(std::string path, SourcePlace key_place, const toml::table& table) {
    const toml::node* value = table.get("value");
    TomlEntry entry = plain_entry(std::move(path), std::move(key_place), value ? *value : table);
    for (const auto& [key, node] : table) {
      if (key == "value") continue;
      if (key == "provenance" && node.is_string()) {
        entry.provenance = **node.as_string();
        entry.provenance_place = place(node.source());
      } else if (key == "source" && node.is_string()) {
        entry.source = **node.as_string();
      } else if (key == "interval") {
        read_interval(entry, node);
      } else {
        complain(entry.path, std::string(key.str()), place(key.source()));
      }
    }
    return entry;
  }

  void read_interval(TomlEntry& entry, const toml::node& node) {
    const toml::array* pair = node.as_array();
    const auto number = [&](std::size_t i) { return (*pair)[i].value<double>(); };
    if (pair && pair->size() == 2 && (*pair)[0].is_number() && (*pair)[1].is_number()) {
      const double low = *number(0), high = *number(1);
      if (std::isfinite(low) && std::isfinite(high) && low <= high) {
        entry.interval = {low, high};
        return;
      }
    }
    problems_.push_back(
        {.code = "C022",
         .message = "the interval of `" + entry.path + "` must be two numbers [low, high], low <= high",
         .place = place(node.source()),
         .help = "write interval = [LOW, HIGH] around the value, or leave it out"});
  }

  void complain(const std::string& path, const std::string& field, SourcePlace where) {
    static const std::vector<std::string> kFields = {"value", "provenance", "source", "interval"};
    const bool known = std::find(kFields.begin(), kFields.end(), field) != kFields.end();
    Diagnostic d;
    d.code = "C022";
    d.place = std::move(where);
    d.message = known ? "`" + field + "` of `" + path + "` must be a text"
                      : "unknown field `" + field + "` in the table of `" + path + "`";
    if (!known) d.hint = did_you_mean(field, kFields);
    d.help = "the fields are value, provenance, source and interval";
    problems_.push_back(std::move(d));
  }

  std::string file_;
  std::vector<std::string> lines_;
  std::vector<Diagnostic>& problems_;
  std::vector<TomlEntry> entries_;
};

/// None where it cannot be read, or is larger than any setting needs.
std::optional<std::string> read_text(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  if (std::filesystem::file_size(path, error) > kFileBytesMax) return std::nullopt;
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) return std::nullopt;
  return text.str();
}

}  // namespace

TomlFile read_toml_file(const std::string& path, std::vector<Diagnostic>& problems) {
  TomlFile file{path, {}};
  const auto text = read_text(path);
  if (!text) {
    problems.push_back({.code = "C010",
                        .message = "cannot read the file `" + path + "`",
                        .place = {.file = path},
                        .help = "check that it exists, is a file of at most 4 MiB and may be read"});
    return file;
  }
  Flattener flattener(path, *text, problems);
  if (const auto deep = too_deep(*text)) {
    problems.push_back({.code = "C011",
                        .message = deep->what,
                        .place = flattener.place(deep->line, deep->column),
                        .help = "write flatter keys and values: settings need two levels"});
    return file;
  }
  try {
    const toml::table table = toml::parse(*text);
    flattener.flatten(table, "");
    file.entries = flattener.take();
  } catch (const toml::parse_error& error) {
    problems.push_back({.code = "C011",
                        .message = "not TOML: " + std::string(error.description()),
                        .place = flattener.place(error.source()),
                        .help = "a line is key = value, with texts in quotes; mend what stands at the mark"});
  }
  return file;
}

}  // namespace hwsim
