#include "lab/environment.h"

#include <charconv>
#include <cstdlib>
#include <filesystem>

#include "lab/base/messages.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

std::string cache_folder() {
  if (std::string own = variable("HWSIM_CACHE"); !own.empty()) return own;
  if (const std::string base = variable("XDG_CACHE_HOME"); !base.empty())
    return (fs::path(base) / "hwsim").string();
  if (const std::string home = variable("HOME"); !home.empty())
    return (fs::path(home) / ".cache" / "hwsim").string();
  std::error_code error;
  const fs::path temporary = fs::temp_directory_path(error);
  return ((error ? fs::path(".") : temporary) / "hwsim-cache").string();
}

std::uint64_t bytes_of(const char* name, std::uint64_t otherwise) {
  const std::string text = variable(name);
  if (text.empty()) return otherwise;
  std::uint32_t mib = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, mib);
  if (error != std::errc() || stop != end)
    fail("U017", std::string(name) + " is `" + text + "`, must be a whole number of MiB", "",
         std::string(name) + "=" + std::to_string(otherwise >> 20) + " is the default, 0 keeps none");
  return std::uint64_t{mib} << 20;
}

}  // namespace

LabOptions options_of_environment() {
  return {.config_folder = variable("HWSIM_CONFIG_DIR"),
          .page_folder = variable("HWSIM_PAGE_DIR"),
          .cache_folder = cache_folder(),
          .cache_limit_bytes = bytes_of("HWSIM_CACHE_MIB", kDefaultCacheLimitBytes),
          .shared_passes_bytes = bytes_of("HWSIM_SHARED_PASSES_MIB", kDefaultSharedPassesBytes)};
}

}  // namespace hwsim::lab
