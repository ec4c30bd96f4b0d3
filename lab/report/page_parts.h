#pragma once
// The parts of a report's page that are built with hwsim (page/): style, script, engine.
#include <string>
#include <vector>

namespace hwsim::lab {

struct PageParts {
  std::string style{}, script{};
  std::string engine{};                ///< WebAssembly
  std::vector<std::string> missing{};  ///< what the page lacks without the parts that are not there, in words
};

/// From `folder`; empty: ../share/hwsim/page beside the program's folder, else the folder of the build. A
/// part that is not there is empty, and said in `missing`.
PageParts read_page_parts(const std::string& folder = {});

}  // namespace hwsim::lab
