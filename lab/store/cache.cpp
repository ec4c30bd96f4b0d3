#include "lab/store/cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>

#include "hwsim/base/content_hash.h"
#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/base/table.h"
#include "pipeline/base/file_io.h"
#include "pipeline/open/scene_source.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMib = std::uint64_t{1} << 20;
constexpr std::uint64_t kDefaultLimitMib = 4096;
constexpr std::size_t kMaxEntryBytes = std::size_t{8} << 30;  // a 16384x16384 image and its heat map

std::string duration_file(const std::string& key) {
  return cache_directory(CacheFolder::durations) + "/" + hash_hex(key);
}

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

void list_folder(CacheFolder folder, std::vector<CachedFile>& files) {
  const auto now = fs::file_time_type::clock::now();
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(cache_directory(folder), error)) {
    std::error_code gone;  // another process may remove it meanwhile
    if (!entry.is_regular_file(gone)) continue;
    const std::chrono::duration<double, std::ratio<86400>> age = now - entry.last_write_time(gone);
    const std::uint64_t bytes = entry.file_size(gone);
    if (!gone) files.push_back({folder_name(folder), entry.path(), bytes, std::max(0.0, age.count())});
  }
}

void keep_traces_below_limit() {
  std::vector<CachedFile> files;
  list_folder(CacheFolder::traces, files);
  for (const CachedFile& file : least_recently_used(std::move(files), cache_limit_bytes())) {
    std::error_code ignored;  // already removed by another process
    fs::remove(file.path, ignored);
  }
}

}  // namespace

std::string cache_directory(CacheFolder folder) {
  return (fs::path(pipeline::default_cache_directory()) / folder_name(folder)).string();
}

std::string cache_path(CacheFolder folder, const std::string& key, const std::string& ending) {
  ContentHash hash;
  hash.add({reinterpret_cast<const std::uint8_t*>(key.data()), key.size()});
  return (fs::path(cache_directory(folder)) / (hash.hex() + ending)).string();
}

std::optional<std::vector<std::uint8_t>> read_cached(const std::string& path) try {
  return pipeline::read_file(path, "U011", kMaxEntryBytes);
} catch (const InputError&) {
  return std::nullopt;
}

void write_cached(const std::string& path, std::span<const std::uint8_t> bytes, Observer& observer) try {
  std::error_code error;  // the write says what is wrong
  fs::create_directories(fs::path(path).parent_path(), error);
  pipeline::write_file_atomically(path, "U010", bytes);
  if (fs::path(path).parent_path() == cache_directory(CacheFolder::traces)) keep_traces_below_limit();
} catch (const InputError& failure) {
  if (failure.diagnostics().front().code == "U017") throw;
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

std::uint64_t cache_limit_bytes() {
  const char* text = std::getenv("HWSIM_CACHE_MIB");
  if (text == nullptr || *text == '\0') return kDefaultLimitMib * kMib;
  const std::string_view view = text;
  std::uint32_t mib = 0;
  const auto [end, error] = std::from_chars(view.data(), view.data() + view.size(), mib);
  if (error != std::errc() || end != view.data() + view.size())
    fail("U017", "HWSIM_CACHE_MIB is `" + std::string(view) + "`, must be a whole number of MiB");
  return mib * kMib;
}

std::vector<CachedFile> cached_files() {
  std::vector<CachedFile> files;
  for (const CacheFolder folder :
       {CacheFolder::scenes, CacheFolder::references, CacheFolder::traces, CacheFolder::durations})
    list_folder(folder, files);
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

std::optional<double> remembered_seconds(const std::string& key) try {
  const std::string text = read_file(duration_file(key));
  const double seconds = std::strtod(text.c_str(), nullptr);
  return seconds > 0.0 && seconds < 1e9 ? std::optional(seconds) : std::nullopt;
} catch (const InputError&) {
  return std::nullopt;
}

void remember_seconds(const std::string& key, double seconds) try {
  std::error_code error;
  fs::create_directories(cache_directory(CacheFolder::durations), error);
  write_file(duration_file(key), exact(seconds) + "\n");
} catch (const InputError&) {  // the estimate is missing the next time, nothing else
}

}  // namespace hwsim::lab
