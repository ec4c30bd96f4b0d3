#include "lab/store/cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "hwsim/base/content_hash.h"
#include "lab/base/messages.h"
#include "lab/base/table.h"
#include "pipeline/base/file_io.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxEntryBytes = std::size_t{8} << 30;  // a 16384x16384 image and its heat map

std::string folder_name(CacheFolder folder) {
  switch (folder) {
    case CacheFolder::scenes:
      return "scenes";
    case CacheFolder::references:
      return "references";
    case CacheFolder::traces:
      return "traces";
    case CacheFolder::durations:
      return "durations";
  }
  return {};
}

}  // namespace

Cache::Cache(std::string folder, std::uint64_t limit_bytes)
    : own_(folder.empty() ? std::make_unique<TemporaryFolder>() : nullptr),
      folder_(own_ ? own_->path().string() : std::move(folder)),
      limit_bytes_(limit_bytes) {}

std::string Cache::directory(CacheFolder kind) const {
  return (fs::path(folder_) / folder_name(kind)).string();
}

std::string Cache::path(CacheFolder kind, const std::string& key, const std::string& ending) const {
  ContentHash hash;
  hash.add({reinterpret_cast<const std::uint8_t*>(key.data()), key.size()});
  return (fs::path(directory(kind)) / (hash.hex() + ending)).string();
}

std::string Cache::duration_file(const std::string& key) const {
  return directory(CacheFolder::durations) + "/" + hash_hex(key);
}

void Cache::list(CacheFolder kind, std::vector<CachedFile>& files) const {
  const auto now = fs::file_time_type::clock::now();
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory(kind), error)) {
    std::error_code gone;  // another process may remove it meanwhile
    if (!entry.is_regular_file(gone)) continue;
    const std::chrono::duration<double, std::ratio<86400>> age = now - entry.last_write_time(gone);
    const std::uint64_t bytes = entry.file_size(gone);
    if (!gone) files.push_back({folder_name(kind), entry.path(), bytes, std::max(0.0, age.count())});
  }
}

void Cache::keep_traces_below_limit() const {
  std::vector<CachedFile> files;
  list(CacheFolder::traces, files);
  for (const CachedFile& file : least_recently_used(std::move(files), limit_bytes_)) {
    std::error_code ignored;  // already removed by another process
    fs::remove(file.path, ignored);
  }
}

std::optional<std::vector<std::uint8_t>> read_cached(const std::string& path) try {
  return pipeline::read_file(path, "U011", kMaxEntryBytes);
} catch (const InputError&) {
  return std::nullopt;
}

void Cache::write(const std::string& path, std::span<const std::uint8_t> bytes, Observer& observer) const
    try {
  std::error_code error;  // the write says what is wrong
  fs::create_directories(fs::path(path).parent_path(), error);
  pipeline::write_file_atomically(path, "U010", bytes);
  if (fs::path(path).parent_path() == directory(CacheFolder::traces)) keep_traces_below_limit();
} catch (const InputError& failure) {
  Diagnostic note = problem("K002", "the cache cannot be written: " + std::string(failure.what()), "",
                            "set HWSIM_CACHE to a folder that can be written");
  note.severity = Severity::note;
  note.notes = {"results are not affected; the next run will do this work again"};
  note.place.file = path;
  observer.report(note);
}

void mark_used(const std::string& path) {
  std::error_code ignored;  // a cache that may only be read
  fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
}

void note_damage(Observer& observer, const std::string& path, const std::string& reason) {
  Diagnostic note = problem("K001", "a file of the cache is damaged (" + reason + ") and is made anew");
  note.severity = Severity::note;
  note.place.file = path;
  observer.report(note);
}

std::vector<CachedFile> Cache::files() const {
  std::vector<CachedFile> files;
  for (const CacheFolder folder :
       {CacheFolder::scenes, CacheFolder::references, CacheFolder::traces, CacheFolder::durations})
    list(folder, files);
  std::sort(files.begin(), files.end(),
            [](const CachedFile& a, const CachedFile& b) { return a.path < b.path; });
  return files;
}

std::vector<CachedFile> least_recently_used(std::vector<CachedFile> files, std::uint64_t limit_bytes) {
  std::sort(files.begin(), files.end(),
            [](const CachedFile& a, const CachedFile& b) { return a.age_days < b.age_days; });
  std::uint64_t kept_bytes = 0;
  const auto first_to_go = std::find_if(files.begin(), files.end(), [&](const CachedFile& file) {
    return (kept_bytes += file.bytes) > limit_bytes;
  });
  files.erase(files.begin(), first_to_go);
  std::reverse(files.begin(), files.end());
  return files;
}

std::optional<double> Cache::remembered_seconds(const std::string& key) const try {
  const std::string text = read_file(duration_file(key));
  const double seconds = std::strtod(text.c_str(), nullptr);
  return seconds > 0.0 && seconds < 1e9 ? std::optional(seconds) : std::nullopt;
} catch (const InputError&) {
  return std::nullopt;
}

void Cache::remember_seconds(const std::string& key, double seconds) const try {
  std::error_code error;
  fs::create_directories(directory(CacheFolder::durations), error);
  write_file(duration_file(key), exact(seconds) + "\n");
} catch (const InputError&) {  // the estimate is missing the next time, nothing else
}

}  // namespace hwsim::lab
