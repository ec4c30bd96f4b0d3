#include "lab/store/cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "hwsim/base/byte_codec.h"
#include "hwsim/base/content_hash.h"
#include "lab/base/messages.h"
#include "pipeline/base/sealed_file.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

constexpr pipeline::SealKind kSeconds = {"seconds", "one real number"};

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

std::optional<std::vector<std::uint8_t>> Cache::read(const std::string& path, const pipeline::SealKind& kind,
                                                     Observer& observer) const {
  pipeline::SealedContent content = pipeline::read_sealed(path, kind);
  if (!content.damage.empty()) note_damage(observer, path, content.damage);
  return std::move(content.bytes);
}

void Cache::write(const std::string& path, const pipeline::SealKind& kind,
                  std::span<const std::uint8_t> payload, Observer& observer) const try {
  const std::string folder = fs::path(path).parent_path().string();
  if (const std::string fault = pipeline::make_private_folder(folder); !fault.empty())
    fail("K002", "the folder `" + folder + "` cannot be used: " + fault);
  pipeline::write_sealed(path, kind, "K002", payload);
  if (folder == directory(CacheFolder::traces)) keep_traces_below_limit();
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

std::size_t Cache::remove_abandoned() const {
  std::size_t removed = 0;
  for (const CachedFile& file : files())
    if (pipeline::is_unfinished_name(file.path.filename().string()) &&
        pipeline::remove_if_abandoned(file.path.string()))
      ++removed;
  return removed;
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
  const auto bytes = pipeline::read_sealed(duration_file(key), kSeconds).bytes;
  if (!bytes) return std::nullopt;
  const double seconds = ByteReader(*bytes).real();
  return seconds > 0.0 && seconds < 1e9 ? std::optional(seconds) : std::nullopt;
} catch (const DamagedBytes&) {
  return std::nullopt;
}

void Cache::remember_seconds(const std::string& key, double seconds) const {
  ByteWriter out;
  out.real(seconds);
  Observer silent;
  write(duration_file(key), kSeconds, out.take(), silent);
}

}  // namespace hwsim::lab
