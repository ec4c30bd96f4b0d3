#pragma once
// Which folder of the project includes which, as the rules' tests see it.
#include <map>
#include <set>
#include <string>
#include <vector>

#include "rules/documents.h"

namespace hwsim::test {

/// The folders whose sources obey the include rule: the libraries and the programs.
extern const std::vector<std::string> kSourceFolders;

/// An include of a file of the project by another, both below one of kSourceFolders.
struct Include {
  TextLine line;   ///< where it stands
  std::string to;  ///< the file that it names
  std::string from_folder() const { return line.file.parent_path().generic_string(); }
  std::string to_folder() const;
};

std::vector<Include> project_includes();

/// The folders below `top`, itself included, that hold sources of their own.
std::set<std::string> folders_with_sources(const std::string& top);

/// An arrow between two children of a folder, each child with all that lies below it, and the includes that
/// make it. The folder's own files are a child of its name.
using Arrows = std::map<std::string, std::map<std::string, std::vector<Include>>>;
Arrows arrows_between_children(const std::string& parent, const std::vector<Include>& includes);

/// The arrows that are part of a circle.
std::vector<Include> circular(const Arrows& arrows);

}  // namespace hwsim::test
