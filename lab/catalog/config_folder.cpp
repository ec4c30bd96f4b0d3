#include "lab/catalog/config_folder.h"

#include <algorithm>
#include <filesystem>

#include "hwsim/base/file_name.h"
#include "lab/base/messages.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

bool has_gpus(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder / "gpus", error);
}

std::string below(const std::string& folder, const char* name) { return (fs::path(folder) / name).string(); }

}  // namespace

std::string ConfigFolder::path() const {
  if (!named_.empty()) {
    if (has_gpus(named_)) return named_;
    fail("U012", "the configuration folder is `" + named_ + "`, which holds no folder gpus", "",
         "name another one, or none (unset HWSIM_CONFIG_DIR) for the files that came with hwsim");
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / "share" / "hwsim" / "configs";
  for (const fs::path& candidate : {installed, fs::path(HWSIM_SOURCE_CONFIG_DIR)})
    if (has_gpus(candidate)) return candidate.string();
  fail("U012",
       "the configuration files are neither in `" + installed.string() + "` nor in `" +
           HWSIM_SOURCE_CONFIG_DIR + "`",
       "", "install hwsim again, or set HWSIM_CONFIG_DIR to the folder that holds gpus");
}

std::string ConfigFolder::gpus() const { return below(path(), "gpus"); }
std::string ConfigFolder::published() const { return below(path(), "published"); }
std::string ConfigFolder::external() const { return below(path(), "external"); }
std::string ConfigFolder::calibration() const { return below(path(), "calibration"); }
std::string ConfigFolder::calibrated() const { return below(path(), "calibrated"); }

std::vector<std::string> ConfigFolder::overlay_names() const {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(below(path(), "overlays"), error))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string ConfigFolder::overlay_file(const std::string& name_or_path) const {
  if (has_extension(name_or_path, ".toml")) return name_or_path;
  const fs::path file = fs::path(below(path(), "overlays")) / (name_or_path + ".toml");
  std::error_code error;
  if (fs::is_regular_file(file, error)) return file.string();
  fail("U018", "no overlay `" + name_or_path + "` comes with hwsim",
       did_you_mean(name_or_path, overlay_names()),
       "`hwsim list overlays` lists them; a file's name ends in .toml");
}

std::string ConfigFolder::prices_file(const std::string& name_or_path) const {
  if (has_extension(name_or_path, ".toml")) return name_or_path;
  const fs::path file = fs::path(below(path(), "prices")) / (name_or_path + ".toml");
  std::error_code error;
  if (fs::is_regular_file(file, error)) return file.string();
  fail("C010", "no list of prices `" + name_or_path + "` comes with hwsim", "",
       "`example`, or your own: a file whose name ends in .toml");
}

}  // namespace hwsim::lab
