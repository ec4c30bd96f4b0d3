#include "lab/report/page_parts.h"

#include <filesystem>

#include "lab/base/files.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

fs::path found_folder(const std::string& named) {
  if (!named.empty()) return named;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / "share" / "hwsim" / "page";
  return fs::is_directory(installed, error) ? installed : fs::path(HWSIM_BUILT_PAGE_DIR);
}

std::string part(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error) ? read_file(file.string()) : std::string();
}

}  // namespace

PageParts read_page_parts(const std::string& named) {
  const fs::path folder = found_folder(named);
  PageParts parts{.style = part(folder / "page.css"),
                  .script = part(folder / "page.js"),
                  .engine = part(folder / "engine.wasm")};
  if (parts.style.empty()) parts.missing.emplace_back("its style: page.css was not built");
  if (parts.script.empty())
    parts.missing.emplace_back(
        "charts, the comparer of pictures and hardware that can be moved: page.js was not built, which takes "
        "Node and `scripts/setup.sh --report`");
  else if (parts.engine.empty())
    parts.missing.emplace_back(
        "hardware that can be moved: engine.wasm was not built, which takes clang for WebAssembly and "
        "`scripts/setup.sh --report`");
  return parts;
}

}  // namespace hwsim::lab
