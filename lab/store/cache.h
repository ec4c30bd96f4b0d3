#pragma once
// Files that can be made anew: generated scenes, references, work traces, and how long runs took.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lab/base/observer.h"

namespace hwsim::lab {

enum class CacheFolder { scenes, references, traces, durations };

/// "<root>/scenes", with <root> = pipeline::default_cache_directory().
std::string cache_directory(CacheFolder folder);

/// The file for a key: its name is a hash of the key.
std::string cache_path(CacheFolder folder, const std::string& key, const std::string& ending);

/// None when there is no such file, or it cannot be read.
std::optional<std::vector<std::uint8_t>> read_cached(const std::string& path);

/// Whole or not at all. A cache that cannot be written is no error: a note says that the next run will work
/// again. What was used least recently goes when the traces take more than cache_limit_bytes().
void write_cached(const std::string& path, std::span<const std::uint8_t> bytes, Observer& observer);

/// The file was used now: it goes last.
void mark_used(const std::string& path);

/// One note: the file is damaged, and made anew.
void note_damage(Observer& observer, const std::string& path, const std::string& reason);

/// $HWSIM_CACHE_MIB, else 4 GiB. Throws InputError U017.
std::uint64_t cache_limit_bytes();

struct CachedFile {
  std::string folder;
  std::filesystem::path path;
  std::uint64_t bytes = 0;
  double age_days = 0.0;  ///< since it was written, or a trace used
};

/// Only what hwsim itself writes, sorted by path; whatever else lies in the cache directory is not ours.
std::vector<CachedFile> cached_files();

/// Those to remove, the oldest first, until the others have at most `limit_bytes`.
std::vector<CachedFile> least_recently_used(std::vector<CachedFile> files, std::uint64_t limit_bytes);

/// How long the same work took the last time. A cache that cannot be written or holds something else is no
/// error.
std::optional<double> remembered_seconds(const std::string& key);
void remember_seconds(const std::string& key, double seconds);

}  // namespace hwsim::lab
