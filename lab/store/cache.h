#pragma once
// Files that can be made anew: generated scenes, references, work traces, and how long runs took.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lab/base/files.h"
#include "lab/base/lab_options.h"

namespace hwsim::lab {

enum class CacheFolder { scenes, references, traces, durations };

struct CachedFile {
  std::string folder;
  std::filesystem::path path;
  std::uint64_t bytes = 0;
  double age_days = 0.0;  ///< since it was written, or a trace used
};

/// One folder with a folder for each kind of file. Two caches know nothing of each other.
class Cache {
 public:
  /// Without a folder, files live as long as the cache. `limit_bytes` is that of the traces.
  explicit Cache(std::string folder, std::uint64_t limit_bytes = kDefaultCacheLimitBytes);

  const std::string& folder() const { return folder_; }
  std::string directory(CacheFolder kind) const;

  /// The file for a key: its name is a hash of the key.
  std::string path(CacheFolder kind, const std::string& key, const std::string& ending) const;

  /// Whole or not at all. A cache that cannot be written is no error: a note says that the next run will work
  /// again. What was used least recently goes when the traces take more than the limit.
  void write(const std::string& path, std::span<const std::uint8_t> bytes, Observer& observer) const;

  /// Only what hwsim itself writes, sorted by path; whatever else lies in the folder is not ours.
  std::vector<CachedFile> files() const;

  /// How long the same work took the last time. A cache that cannot be written or holds something else is no
  /// error.
  std::optional<double> remembered_seconds(const std::string& key) const;
  void remember_seconds(const std::string& key, double seconds) const;

 private:
  void list(CacheFolder kind, std::vector<CachedFile>& files) const;
  void keep_traces_below_limit() const;
  std::string duration_file(const std::string& key) const;

  std::unique_ptr<TemporaryFolder> own_;  ///< none where a folder was named
  std::string folder_;
  std::uint64_t limit_bytes_;
};

/// None when there is no such file, or it cannot be read.
std::optional<std::vector<std::uint8_t>> read_cached(const std::string& path);

/// The file was used now: it goes last.
void mark_used(const std::string& path);

/// One note: the file is damaged, and made anew.
void note_damage(Observer& observer, const std::string& path, const std::string& reason);

/// Those to remove, the oldest first, until the others have at most `limit_bytes`.
std::vector<CachedFile> least_recently_used(std::vector<CachedFile> files, std::uint64_t limit_bytes);

}  // namespace hwsim::lab
