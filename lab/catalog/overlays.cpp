#include "lab/catalog/overlays.h"

#include <algorithm>
#include <filesystem>

#include "hwsim/base/file_name.h"
#include "hwsim/config/toml_file.h"
#include "lab/base/files.h"
#include "lab/base/messages.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

fs::path overlay_directory() { return fs::path(config_directory()) / "overlays"; }

}  // namespace

std::vector<std::string> overlay_names() {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(overlay_directory(), error))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string overlay_file(const std::string& name_or_path) {
  if (has_extension(name_or_path, ".toml")) return name_or_path;
  const fs::path path = overlay_directory() / (name_or_path + ".toml");
  std::error_code error;
  if (fs::is_regular_file(path, error)) return path.string();
  fail("U018", "no overlay `" + name_or_path + "` comes with hwsim",
       did_you_mean(name_or_path, overlay_names()),
       "`hwsim list overlays` lists them; a file's name ends in .toml");
}

Table overlay_catalog() {
  Table table{{{"name", "name"}, {"about", "what if", false, 60}, {"changes", "changes", false, 50}}, {}};
  for (const std::string& name : overlay_names()) {
    std::vector<Diagnostic> problems;
    std::string about, changes;
    for (const TomlEntry& entry : read_toml_file(overlay_file(name), problems).entries) {
      if (!entry.value || entry.path == "schema" || entry.path == "kind") continue;
      const auto* text = std::get_if<std::string>(&*entry.value);
      if (entry.path == "about" && text)
        about = *text;
      else
        changes += (changes.empty() ? "" : ", ") + entry.path + " " + (text ? *text : to_toml(*entry.value));
    }
    table.rows.push_back({name, about, changes});
  }
  return table;
}

}  // namespace hwsim::lab
