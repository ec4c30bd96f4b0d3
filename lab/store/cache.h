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

namespace hwsim::pipeline {
struct SealKind;
}

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

  /// What a file holds, of this kind and version. None where there is no such file; one that is damaged or
  /// another user's is noted, and as good as not there.
  std::optional<std::vector<std::uint8_t>> read(const std::string& path, const pipeline::SealKind& kind,
                                                Observer& observer) const;

  /// Sealed, whole or not at all, in a folder that is this user's alone. A cache that cannot be written is no
  /// error: a note says that the next run will work again. What was used least recently goes when the traces
  /// take more than the limit.
  void write(const std::string& path, const pipeline::SealKind& kind, std::span<const std::uint8_t> payload,
             Observer& observer) const;

  /// Only what hwsim itself writes, sorted by path; whatever else lies in the folder is not ours.
  std::vector<CachedFile> files() const;

  /// Removes what writers that are gone did not finish. Returns how many files.
  std::size_t remove_abandoned() const;

  /// How long the same work took the last time. A cache that cannot be written or holds something else is no
  /// error, and not worth a note: an estimate is missing, nothing else.
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

/// The file was used now: it goes last.
void mark_used(const std::string& path);

/// One note: the file is damaged, and made anew.
void note_damage(Observer& observer, const std::string& path, const std::string& reason);

/// Those to remove, the oldest first, until the others have at most `limit_bytes`.
std::vector<CachedFile> least_recently_used(std::vector<CachedFile> files, std::uint64_t limit_bytes);

}  // namespace hwsim::lab
