#include "lab/base/files.h"
#include "lab/base/messages.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "hwsim/base/content_hash.h"
#include "pipeline/base/file_io.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxTextBytes = std::size_t{64} << 20;  // far more than any text file of the project

}  // namespace

void write_file(const std::string& path, std::string_view text) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  pipeline::write_file_atomically(path, "U010", {bytes, text.size()});
}

std::string read_file(const std::string& path) {
  const std::vector<std::uint8_t> bytes = pipeline::read_file(path, "U011", kMaxTextBytes);
  return std::string(bytes.begin(), bytes.end());
}

std::string config_directory() {
  if (const char* set = std::getenv("HWSIM_CONFIG_DIR"); set != nullptr && *set != '\0') {
    if (fs::is_directory(fs::path(set) / "gpus")) return set;
    fail("U012", "HWSIM_CONFIG_DIR is `" + std::string(set) + "`, which holds no folder gpus", "",
         "unset HWSIM_CONFIG_DIR to use the files that came with hwsim");
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / "share" / "hwsim" / "configs";
  for (const fs::path& candidate : {installed, fs::path(HWSIM_SOURCE_CONFIG_DIR)})
    if (fs::is_directory(candidate / "gpus", error)) return candidate.string();
  fail("U012",
       "the configuration files are neither in `" + installed.string() + "` nor in `" +
           HWSIM_SOURCE_CONFIG_DIR + "`",
       "", "install hwsim again, or set HWSIM_CONFIG_DIR to the folder that holds gpus");
}

std::string gpu_directory() { return (fs::path(config_directory()) / "gpus").string(); }

std::string hash_hex(std::string_view bytes) { return fmt::format("{:016x}", fnv1a(bytes)); }

}  // namespace hwsim::lab
