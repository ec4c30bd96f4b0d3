#include "rules/documents.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>

#include "support/places.h"

namespace hwsim::test {
namespace {

namespace fs = std::filesystem;

const char* const kFolders[] = {".ci",     "algos",       "benchmarks", "cli",      "cmake",
                                "configs", "cost_models", "docs",       "hwsim",    "lab",
                                "python",  "scripts",     "tests",      "pipeline", "page"};

bool starts_with(const std::string& text, const std::string& start) { return text.rfind(start, 0) == 0; }

/// GitHub's anchor of a heading: letters and digits, spaces as hyphens, everything else dropped.
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading) {
    const auto code = static_cast<unsigned char>(c);
    if (std::isalnum(code) != 0 || c == '-' || c == '_' || code >= 0x80)
      anchor += static_cast<char>(std::tolower(code));
    else if (c == ' ')
      anchor += '-';
  }
  return anchor;
}

std::string without_code(std::string line) {
  bool code = false;
  for (char& c : line) {
    const bool tick = c == '`';
    if (code || tick) c = ' ';
    if (tick) code = !code;
  }
  return line;
}

}  // namespace

std::vector<fs::path> project_files(const std::vector<std::string>& extensions) {
  const fs::path root = source_dir();
  std::vector<fs::path> files;
  const auto add = [&](const fs::directory_entry& entry) {
    const std::string extension = entry.path().extension().string();
    if (entry.is_regular_file() && std::ranges::find(extensions, extension) != extensions.end())
      files.push_back(fs::relative(entry.path(), root));
  };
  for (const auto& entry : fs::directory_iterator(root)) add(entry);
  for (const char* folder : kFolders)
    if (fs::exists(root / folder))
      for (fs::recursive_directory_iterator entry(root / folder); entry != fs::recursive_directory_iterator();
           ++entry) {
        if (entry->path().filename() == "node_modules")
          entry.disable_recursion_pending();  // not the project's
        add(*entry);
      }
  std::ranges::sort(files);
  return files;
}

std::vector<TextLine> lines_of(const fs::path& file) {
  std::ifstream stream(fs::path(source_dir()) / file);
  std::vector<TextLine> lines;
  int number = 0;
  for (std::string text; std::getline(stream, text);) lines.push_back({file, ++number, text});
  return lines;
}

std::vector<TextLine> prose_of(const fs::path& page) {
  std::vector<TextLine> prose;
  bool fenced = false;
  for (TextLine& line : lines_of(page)) {
    if (starts_with(line.text, "```")) {
      fenced = !fenced;
      continue;
    }
    if (fenced || starts_with(line.text, "    ")) continue;
    line.text = without_code(line.text);
    prose.push_back(std::move(line));
  }
  return prose;
}

std::set<std::string> anchors_of(const fs::path& page) {
  std::set<std::string> anchors;
  std::map<std::string, int> seen;
  bool fenced = false;
  for (const TextLine& line : lines_of(page)) {
    if (starts_with(line.text, "```")) fenced = !fenced;
    const std::size_t level = line.text.find_first_not_of('#');
    if (fenced || level == 0 || level == std::string::npos || line.text[level] != ' ') continue;
    const std::string anchor = anchor_of(line.text.substr(level + 1));
    const int before = seen[anchor]++;
    anchors.insert(before == 0 ? anchor : anchor + "-" + std::to_string(before));
  }
  return anchors;
}

std::string broken_link(const fs::path& folder, const std::string& target) {
  if (target.find("://") != std::string::npos || starts_with(target, "mailto:")) return {};
  const std::size_t hash = target.find('#');
  const std::string name = target.substr(0, hash);
  const fs::path file = (folder / name).lexically_normal();
  if (!name.empty() && !fs::exists(fs::path(source_dir()) / file)) return "no file " + file.string();
  if (hash == std::string::npos) return {};
  if (name.empty()) return "an anchor without a page";
  if (!anchors_of(file).contains(target.substr(hash + 1)))
    return file.string() + " has no section #" + target.substr(hash + 1);
  return {};
}

}  // namespace hwsim::test
