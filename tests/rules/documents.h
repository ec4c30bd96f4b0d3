#pragma once
// The project's texts as the rules' tests read them: files, lines, and what a page of Markdown names.
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace hwsim::test {

/// A line of a file, for messages.
struct TextLine {
  std::filesystem::path file;  ///< from the project's root
  int number = 0;              ///< from 1
  std::string text;
  std::string place() const { return file.string() + ":" + std::to_string(number); }
};

/// The files of the project with one of the extensions (".md"), in sorted order, paths from its root. Build
/// folders and runs are left out.
std::vector<std::filesystem::path> project_files(const std::vector<std::string>& extensions);

std::vector<TextLine> lines_of(const std::filesystem::path& file);

/// The lines of a page that are no code: fenced and indented blocks are left out, code within a line is
/// blanked.
std::vector<TextLine> prose_of(const std::filesystem::path& page);

/// The anchors of a page's headings, as GitHub makes them: "## Early depth" is "early-depth".
std::set<std::string> anchors_of(const std::filesystem::path& page);

/// What is wrong with the target of a link, such as "page.md#section", that stands in a file of `folder`.
/// Empty if it resolves, or leads out of the project (https:).
std::string broken_link(const std::filesystem::path& folder, const std::string& target);

}  // namespace hwsim::test
