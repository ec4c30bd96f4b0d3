#include "cli/cache.h"

#include <cstdlib>
#include <filesystem>

#include "cli/files.h"
#include "cli/table.h"
#include "hwsim/base/diagnostics.h"
#include "pipeline/scene/scene_source.h"

namespace hwsim::cli {
namespace {

std::string duration_file(const std::string& key) {
  return cache_directory(CacheFolder::durations) + "/" + hash_hex(key);
}

std::string folder_name(CacheFolder folder) {
  switch (folder) {
    case CacheFolder::scenes:
      return "scenes";
    case CacheFolder::references:
      return "references";
    case CacheFolder::durations:
      return "durations";
  }
  return {};
}

}  // namespace

std::string cache_directory(CacheFolder folder) {
  return (std::filesystem::path(pipeline::default_cache_directory()) / folder_name(folder)).string();
}

std::optional<double> remembered_seconds(const std::string& key) try {
  const std::string text = read_file(duration_file(key));
  const double seconds = std::strtod(text.c_str(), nullptr);
  return seconds > 0.0 && seconds < 1e9 ? std::optional(seconds) : std::nullopt;
} catch (const InputError&) {
  return std::nullopt;
}

void remember_seconds(const std::string& key, double seconds) try {
  std::error_code error;
  std::filesystem::create_directories(cache_directory(CacheFolder::durations), error);
  write_file(duration_file(key), exact(seconds) + "\n");
} catch (const InputError&) {  // the estimate is missing the next time, nothing else
}

}  // namespace hwsim::cli
