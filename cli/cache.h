#pragma once
// Files that can be made anew: generated scenes, references, and how long runs took.
#include <optional>
#include <string>

namespace hwsim::cli {

enum class CacheFolder { scenes, references, durations };

/// "<root>/scenes", with <root> = pipeline::default_cache_directory().
std::string cache_directory(CacheFolder folder);

/// How long the same work took the last time. A cache that cannot be written or holds something else is no
/// error.
std::optional<double> remembered_seconds(const std::string& key);
void remember_seconds(const std::string& key, double seconds);

}  // namespace hwsim::cli
