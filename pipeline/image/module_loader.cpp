#include "pipeline/image/module_loader.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <new>
#include <string>

#include "hwsim/base/diagnostics.h"

namespace hwsim::pipeline {
namespace {

constexpr const char* kModuleFile = "libhwsim_image_io.so";

const HwsimImageModule* open_module(const std::string& path, std::string& error) {
  void* library =
      ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);  // never closed: OIIO keeps threads of its own
  if (!library) {
    const char* reason = ::dlerror();
    error = reason ? reason : "unknown error";
    if (error.find("failed to map segment") != std::string::npos) throw std::bad_alloc();
    return nullptr;
  }
  const auto* module = static_cast<const HwsimImageModule*>(::dlsym(library, "hwsim_image_module"));
  if (module && module->abi_version == kHwsimImageAbiVersion) return module;
  error = path + ": of another version of hwsim";
  return nullptr;
}

}  // namespace

std::vector<std::string> image_module_paths() {
  std::vector<std::string> folders;
  if (const char* folder = std::getenv("HWSIM_MODULE_DIR"); folder && *folder) folders.emplace_back(folder);
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    folders.push_back((program.parent_path().parent_path() / "lib").string());
    folders.push_back(program.parent_path().string());
  }
  folders.emplace_back(HWSIM_MODULE_INSTALL_DIR);
  for (std::string& folder : folders) folder += std::string("/") + kModuleFile;
  folders.emplace_back(kModuleFile);
  return folders;
}

const HwsimImageModule& open_image_module(const std::vector<std::string>& paths) {
  Diagnostic d{.code = "I001", .message = std::string("cannot open the image module ") + kModuleFile};
  for (const std::string& path : paths) {
    std::error_code ignored;
    const bool is_place = path.find('/') != std::string::npos;
    if (is_place && !std::filesystem::exists(path, ignored)) {
      d.notes.push_back("not at " + path);
      continue;
    }
    std::string error;
    if (const HwsimImageModule* module = open_module(path, error)) return *module;
    d.notes.push_back(error);
  }
  d.help = "set HWSIM_MODULE_DIR to the folder that holds it; libopenimageio2.4 must be installed";
  throw InputError(d);
}

const HwsimImageModule& image_module() {
  static const HwsimImageModule& module =
      open_image_module(image_module_paths());  // a failed search is repeated at the next call
  return module;
}

}  // namespace hwsim::pipeline
