#include "rules/folders.h"

#include <filesystem>
#include <regex>

namespace hwsim::test {
namespace {

bool is_source_folder(const std::string& name) {
  for (const std::string& folder : kSourceFolders)
    if (folder == name) return true;
  return false;
}

std::string top_of(const std::filesystem::path& file) { return file.begin()->string(); }

/// The child of `parent` that holds the folder; empty where it lies elsewhere.
std::string child_of(const std::string& parent, const std::string& folder) {
  if (folder == parent) return parent;
  const std::string start = parent + "/";
  if (folder.rfind(start, 0) != 0) return {};
  return folder.substr(0, folder.find('/', start.size()));
}

/// All children that can be reached from `from` along arrows.
std::set<std::string> reached(const Arrows& arrows, const std::string& from) {
  std::set<std::string> seen;
  std::vector<std::string> open = {from};
  while (!open.empty()) {
    const auto at = arrows.find(open.back());
    open.pop_back();
    if (at == arrows.end()) continue;
    for (const auto& [to, includes] : at->second)
      if (seen.insert(to).second) open.push_back(to);
  }
  return seen;
}

}  // namespace

const std::vector<std::string> kSourceFolders = {"hwsim", "pipeline", "algos",      "cost_models", "lab",
                                                 "cli",   "python",   "benchmarks", "page"};

std::string Include::to_folder() const { return std::filesystem::path(to).parent_path().generic_string(); }

std::vector<Include> project_includes() {
  const std::regex pattern(R"rx(\s*#\s*include\s+"([a-z_]+/[^"]+)".*)rx");
  std::vector<Include> includes;
  for (const std::filesystem::path& file : project_files({".h", ".cpp"})) {
    if (!is_source_folder(top_of(file))) continue;
    for (const TextLine& line : lines_of(file)) {
      std::smatch match;
      if (line.text.find("include") == std::string::npos) continue;
      if (std::regex_match(line.text, match, pattern) && is_source_folder(top_of(match[1].str())))
        includes.push_back({line, match[1]});
    }
  }
  return includes;
}

std::set<std::string> folders_with_sources(const std::string& top) {
  std::set<std::string> folders;
  for (const std::filesystem::path& file : project_files({".h", ".cpp"}))
    if (top_of(file) == top) folders.insert(file.parent_path().generic_string());
  return folders;
}

Arrows arrows_between_children(const std::string& parent, const std::vector<Include>& includes) {
  Arrows arrows;
  for (const Include& include : includes) {
    const std::string from = child_of(parent, include.from_folder());
    const std::string to = child_of(parent, include.to_folder());
    if (!from.empty() && !to.empty() && from != to) arrows[from][to].push_back(include);
  }
  return arrows;
}

std::vector<Include> circular(const Arrows& arrows) {
  std::vector<Include> found;
  for (const auto& [from, targets] : arrows)
    for (const auto& [to, includes] : targets)
      if (reached(arrows, to).contains(from)) found.insert(found.end(), includes.begin(), includes.end());
  return found;
}

}  // namespace hwsim::test
